#include "tracker_server/pose/joined_model.hpp"

namespace counterpart {

Model joined_model(const std::vector<PlacedModel>& parts) {
  Model whole;
  Eigen::AlignedBox3d extent;
  for (const auto& [model, X_GM] : parts) {
    const int first_face = static_cast<int>(whole.faces.size());
    const int first_segment = static_cast<int>(whole.segments.size());
    whole.beside.insert(whole.beside.end(), model.beside.begin(), model.beside.end());
    whole.beside.resize(whole.segments.size() + model.segments.size());
    for (std::size_t i = whole.segments.size(); i < whole.beside.size(); ++i)
      for (int& other : whole.beside[i]) other += first_segment;
    for (ModelFace face : model.faces) {
      for (Eigen::Vector3d& corner : face.corners_M) corner = X_GM * corner;
      face.normal_M = X_GM.linear() * face.normal_M;
      whole.faces.push_back(std::move(face));
    }
    for (ModelSegment segment : model.segments) {
      segment.a_M = X_GM * segment.a_M;
      segment.b_M = X_GM * segment.b_M;
      for (int* face : {&segment.face0, &segment.face1})
        if (*face >= 0) *face += first_face;
      extent.extend(segment.a_M).extend(segment.b_M);
      whole.segments.push_back(segment);
    }
  }
  if (!whole.segments.empty()) whole.size_m = extent.sizes().maxCoeff();
  return whole;
}

}  // namespace counterpart
