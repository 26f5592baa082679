// A part of a picture with its pyramid: what lies far from the board need not be made grey.
#pragma once

#include "protocol/vocabulary/intrinsics.hpp"
#include "tracker_server/edges/pyramid.hpp"

namespace counterpart {

struct PictureView {
  Pyramid pyramid;
  cv::Rect part;  // of the whole picture, pixels

  // The camera that would have taken the part alone, and back.
  Intrinsics camera_of_part(Intrinsics whole) const {
    whole.cx -= part.x;
    whole.cy -= part.y;
    return whole;
  }
  Intrinsics camera_of_whole(Intrinsics of_part) const {
    of_part.cx += part.x;
    of_part.cy += part.y;
    return of_part;
  }
};

inline PictureView view_of(const cv::Mat& picture, const cv::Rect& part, int levels) {
  return {build_pyramid(picture(part), levels), part};
}

}  // namespace counterpart
