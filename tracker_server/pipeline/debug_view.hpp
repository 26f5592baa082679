// What the tracker saw: the projected model over the picture, its edge points coloured by verdict.
#pragma once

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/message.hpp"
#include "tracker_server/pose/fit.hpp"
#include "tracker_server/pose/model.hpp"

namespace counterpart {

// The model's edges that can be seen from X_CM, and the edge points of the fit's last round.
DebugView debug_view(const Model& model, const Eigen::Isometry3d& X_CM, const Intrinsics& camera, const PoseFit& fit,
                     const FrameStamp& stamp);

// Onto a picture (BGR). Green: accepted; red: an outlier; magenta: wrong contrast; yellow: ambiguous; grey: no edge
// there.
void draw_debug_view(const DebugView& view, cv::Mat& picture_bgr);

}  // namespace counterpart
