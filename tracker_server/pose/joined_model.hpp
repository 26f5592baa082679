// Models that are known to be rigid to each other, as one: what one of them loses to a hand, the others make up for.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tracker_server/pose/model.hpp"

namespace counterpart {

struct PlacedModel {
  Model model;
  Eigen::Isometry3d X_GM = Eigen::Isometry3d::Identity();  // G: the frame of the whole group
};

// Segments and faces in the order of the parts; frame G. Faces of one part hide edges of the others.
Model joined_model(const std::vector<PlacedModel>& parts);

}  // namespace counterpart
