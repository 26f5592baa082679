// Hand shapes, and where a shaped hand's fingertips and skin are.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vhd_renderer/motion/anatomy.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {

struct FingerBend {
  std::array<float, 3> flex_rad{};  // bend at the three joints, from straight; the thumb's first is unused
  float spread_rad = 0;
};

struct HandShape {
  std::array<FingerBend, 5> fingers;
  Eigen::Vector3f thumb_turn_W{0, 0, 0};  // rotation vector of the thumb's saddle joint from bind, y mirrored by side
};

HandShape blend(const HandShape& a, const HandShape& b, float t);

// "relaxed", "flat", "fist", "point", "open", "thumb_up", "chin", "rest", "grip", "tap_a", "tap_b"; unknown names give
// "relaxed".
HandShape hand_shape(const std::string& name);

void apply(const Figure& figure, const HandParts& hand, const HandShape& shape, BodyPose& pose);

struct Fingertip {
  Eigen::Vector3f pad;
  Eigen::Vector3f pad_normal;
  Eigen::Vector3f tip;
};

// In the hand frame W.
Fingertip fingertip_W(const Figure& figure, const HandParts& hand, const HandShape& shape, std::size_t finger);

// The skin of a hand as it is drawn, by finger and palm, for hands that have to touch things.
class HandSkin {
 public:
  static constexpr std::size_t palm = 5, parts = 6;

  // Both have to outlive it.
  HandSkin(const Figure& figure, const HandParts& hand);

  // Every vertex in the hand frame W.
  std::array<std::vector<Eigen::Vector3f>, parts> places_W(const HandShape& shape) const;

 private:
  struct Vertex {
    Eigen::Vector3f p_H;
    std::array<std::uint8_t, 4> bones;
    std::array<float, 4> weights;
  };

  void add(const FigurePart& part, std::size_t v, const std::vector<int>& place);

  const Figure* figure_;
  const HandParts* hand_;
  std::array<std::vector<Vertex>, parts> vertices_;
};

}  // namespace counterpart
