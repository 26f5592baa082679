// The paper's own fit (section 2.1, equation 2): the pose whose projected edges run along the strongest gradients.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/result.hpp"
#include "tracker_server/edges/pyramid.hpp"
#include "tracker_server/pose/fit.hpp"

namespace counterpart {

// How the edges are fitted: by searching along normals (Gauss-Newton), or by the paper's objective and an NLopt
// algorithm, which stands in for the paper's MINOS.
struct Optimizer {
  bool gradient_image = false;
  int nlopt_algorithm = 0;  // an nlopt_algorithm, if gradient_image
};

// "gauss-newton" or "nlopt:" and an algorithm's name, such as LN_BOBYQA. Those that need a second algorithm to work
// inside them (AUGLAG, MLSL) are refused.
[[nodiscard]] Result<Optimizer> optimizer_from(const std::string& name);

// Maximises the mean gradient at the visible samples of the edges over the six parameters of the pose. The gradient
// image has a quarter of the picture's pixels, as in the paper. reach_px: how far the projection may move, roughly.
Eigen::Isometry3d fit_to_gradient(const Pyramid& pyramid, const std::vector<EdgeSample>& samples,
                                  const std::vector<std::size_t>& visible, const Intrinsics& camera,
                                  const Eigen::Isometry3d& start, const Optimizer& optimizer, double reach_px = 25);

// A pose that is given, looked at as fit_pose looks at its own: what agrees with it and what does not.
PoseFit judge_pose(const Pyramid& pyramid, const Model& model, const std::vector<EdgeSample>& samples,
                   const std::vector<std::size_t>& visible, const Intrinsics& camera, const Eigen::Isometry3d& X_CM);

}  // namespace counterpart
