// What stands behind the virtual human in a film that is made offline: a recorded sequence, or a plain painted room.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/scene.hpp"
#include "vhd_renderer/draw/view.hpp"

namespace counterpart {

struct BackdropFrame {
  cv::Mat bgr;  // CV_8UC3, the size of the view's picture
  View view;
  bool seen = true;  // false: the board's pose is not known in this picture, nothing can be drawn into it
};

// Where the camera of a painted room stands, for a human on the light side; turned with him where he sits on the dark
// one.
struct ViewPoint {
  Eigen::Vector3d eye_B{0.10, 0.92, 0.62};
  Eigen::Vector3d look_at_B{0, -0.20, 0.10};
  double zoom = 1.12;  // focal length, in heights of the picture
};

// A SEQUENCE folder (docs/architecture.md): frame_%05d.png|jpg, camera.json, poses.csv. Its last picture stays when the
// film is longer.
class Backdrop {
 public:
  static Result<Backdrop> from_sequence(const std::filesystem::path& folder);

  // No pictures: a wall, a table and a board, seen by the player across it or from elsewhere.
  static Backdrop plain(int width, int height, const ViewPoint& from = {});

  int width() const { return intrinsics_.width; }
  int height() const { return intrinsics_.height; }

  // `scene` says which board stands there and where the human sits.
  Result<BackdropFrame> frame(std::size_t index, const Scene& scene) const;

 private:
  Intrinsics intrinsics_;
  ViewPoint from_;
  std::vector<std::filesystem::path> pictures_;  // empty: plain
  std::map<std::size_t, Eigen::Isometry3d> X_CB_;
};

}  // namespace counterpart
