#include "stage/room/arm.hpp"

#include <algorithm>
#include <cmath>

namespace counterpart::stage {
namespace {

const Eigen::Vector3d kPinchInHand{0.147, 0.010, -0.050};

// z along a direction, x as far up as that allows.
Eigen::Isometry3d along_z(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z = (to - from).normalized();
  const Eigen::Vector3d y = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  X.linear() << y.cross(z), y, z;
  X.translation() = from;
  return X;
}

}  // namespace

ArmPose arm_for(const Eigen::Vector3d& pinch_B) {
  // The player leans forward when he has to reach far.
  const double reach = 0.60;
  Eigen::Vector3d shoulder(-0.20, std::min(0.80, pinch_B.y() + reach), 0.30);
  shoulder.x() += 0.3 * pinch_B.x();
  shoulder.z() -= 0.15 * std::max(0.0, 0.80 - shoulder.y());

  const Eigen::Vector3d ahead = pinch_B - shoulder;
  const double yaw = std::atan2(ahead.y(), ahead.x());
  ArmPose pose;
  pose.X_BHand.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.32, Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  pose.X_BHand.translation() = pinch_B - pose.X_BHand.linear() * kPinchInHand;
  const Eigen::Vector3d wrist = pose.X_BHand.translation();

  // Elbow on the circle that both lengths allow, outwards and down.
  const Eigen::Vector3d line = wrist - shoulder;
  const double span = std::min(line.norm(), 0.999 * (kForearm_m + kUpperArm_m));
  const Eigen::Vector3d direction = line.normalized();
  const double along = (span * span + kUpperArm_m * kUpperArm_m - kForearm_m * kForearm_m) / (2 * span);
  const double out = std::sqrt(std::max(0.0, kUpperArm_m * kUpperArm_m - along * along));
  Eigen::Vector3d side(-0.8, 0.1, -0.6);
  side = (side - side.dot(direction) * direction).normalized();
  Eigen::Vector3d elbow = shoulder + along * direction + out * side;
  elbow.z() = std::max(elbow.z(), 0.04);
  elbow = wrist + (elbow - wrist).normalized() * kForearm_m;
  pose.X_BForearm = along_z(elbow, wrist);
  pose.X_BUpperArm = along_z(shoulder, elbow);
  return pose;
}

// Lengths are those of a grown man's hand: 19 cm, 8.5 cm wide at the knuckles.
std::vector<Capsule> hand_capsules(float piece_radius_m) {
  const auto at = [](float x, float y, float z) { return Eigen::Vector3f(x, y, z); };
  std::vector<Capsule> hand;
  const auto chain = [&](const std::vector<Eigen::Vector3f>& joints, float first, float last) {
    for (std::size_t i = 0; i + 1 < joints.size(); ++i) {
      const float n = static_cast<float>(joints.size() - 1);
      const float ra = first + (last - first) * static_cast<float>(i) / n;
      const float rb = first + (last - first) * static_cast<float>(i + 1) / n;
      hand.push_back({joints[i], joints[i + 1], ra, rb});
    }
  };
  const auto pinch = kPinchInHand.cast<float>();
  const float beyond =
      pinch.x() + piece_radius_m + 0.004f;  // fingers on the far side of the piece, the thumb on the near
  const float before = pinch.x() - piece_radius_m - 0.005f;
  // Palm.
  chain({at(-0.004f, 0.009f, 0), at(0.016f, 0.012f, 0)}, 0.021f, 0.020f);
  chain({at(-0.004f, -0.009f, 0), at(0.016f, -0.010f, 0)}, 0.021f, 0.020f);
  chain({at(0.012f, 0.015f, 0), at(0.088f, 0.029f, 0)}, 0.0165f, 0.0118f);
  chain({at(0.012f, 0.005f, 0.001f), at(0.092f, 0.009f, 0.003f)}, 0.0165f, 0.0120f);
  chain({at(0.012f, -0.005f, 0), at(0.087f, -0.011f, 0.001f)}, 0.0165f, 0.0115f);
  chain({at(0.012f, -0.014f, -0.002f), at(0.079f, -0.030f, -0.003f)}, 0.0155f, 0.0108f);
  // Index, middle, ring, little finger, thumb.
  chain({at(0.088f, 0.029f, 0), at(0.128f, 0.033f, 0.009f), at(0.153f, 0.027f, -0.014f), at(beyond, 0.018f, -0.047f)},
        0.0098f, 0.0066f);
  chain({at(0.092f, 0.009f, 0.003f), at(0.135f, 0.009f, 0.012f), at(0.162f, 0.005f, -0.013f),
         at(beyond + 0.002f, 0.000f, -0.047f)},
        0.0100f, 0.0067f);
  chain({at(0.087f, -0.011f, 0.001f), at(0.128f, -0.017f, 0.007f), at(0.150f, -0.022f, -0.016f),
         at(0.147f, -0.024f, -0.040f)},
        0.0094f, 0.0064f);
  chain({at(0.079f, -0.030f, -0.003f), at(0.110f, -0.042f, 0.002f), at(0.126f, -0.048f, -0.014f),
         at(0.126f, -0.050f, -0.034f)},
        0.0084f, 0.0057f);
  chain({at(0.020f, 0.022f, -0.010f), at(0.060f, 0.050f, -0.024f), at(0.096f, 0.048f, -0.036f),
         at(before, 0.016f, -0.049f)},
        0.0140f, 0.0078f);
  return hand;
}

std::vector<Capsule> wrist_capsules() {
  const auto wrist = static_cast<float>(kForearm_m);
  return {{{0, 0.006f, wrist - 0.10f}, {0, 0.007f, wrist}, 0.029f, 0.0205f},
          {{0, -0.006f, wrist - 0.10f}, {0, -0.007f, wrist}, 0.029f, 0.0205f}};
}

MeshData sleeve_mesh(float length_m, float radius_near_m, float radius_far_m) {
  constexpr int kRings = 22;
  constexpr int kSegments = 22;
  constexpr float kTwoPi = 6.2831853f;
  MeshData mesh;
  const auto radius = [&](float t, float angle) {
    const float plain = radius_near_m + t * (radius_far_m - radius_near_m);
    const float folds = std::sin(19.f * t + 2.f * std::sin(angle)) * std::cos(angle + 5.f * t) +
                        0.6f * std::sin(41.f * t + 3.f * angle);
    return plain * (1 + 0.035f * folds * (0.4f + 0.6f * std::sin(3.1f * t)));
  };
  const auto point = [&](float t, float angle) {
    const float r = radius(t, angle);
    return Eigen::Vector3f(r * std::cos(angle), r * std::sin(angle), t * length_m);
  };
  for (int ring = 0; ring <= kRings; ++ring) {
    const float t = static_cast<float>(ring) / kRings;
    for (int s = 0; s <= kSegments; ++s) {
      const float angle = kTwoPi * static_cast<float>(s) / kSegments;
      const Eigen::Vector3f round = point(t, angle + 0.02f) - point(t, angle - 0.02f);
      const Eigen::Vector3f up = point(t + 0.01f, angle) - point(t - 0.01f, angle);
      mesh.positions_m.push_back(point(t, angle));
      mesh.normals.push_back(round.cross(up).normalized());
      mesh.uvs.emplace_back(6 * static_cast<float>(s) / kSegments, 4 * t);
    }
  }
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t s = 0; s < kSegments; ++s) {
      const std::uint32_t a = ring * (kSegments + 1) + s;
      const std::uint32_t above = a + kSegments + 1;
      mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, above + 1, a, above + 1, above});
    }
  }
  return mesh;
}

std::vector<Capsule> arm_capsules(const ArmPose& pose, float piece_radius_m) {
  std::vector<Capsule> result;
  const Eigen::Isometry3f X_BHand = pose.X_BHand.cast<float>();
  for (const Capsule& capsule : hand_capsules(piece_radius_m)) result.push_back(moved(capsule, X_BHand));
  for (const Capsule& capsule : wrist_capsules()) result.push_back(moved(capsule, pose.X_BForearm.cast<float>()));
  const Eigen::Vector3f tip(0, 0, static_cast<float>(kSleeve_m));
  result.push_back(moved({{0, 0, 0}, tip, kSleeveNear_m, kSleeveFar_m}, pose.X_BForearm.cast<float>()));
  return result;
}

}  // namespace counterpart::stage
