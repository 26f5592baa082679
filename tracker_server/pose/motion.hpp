// Where a moving thing will be next (paper section 2.1).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

enum class Predictor : std::uint8_t { none = 1, first = 2, second = 3 };

[[nodiscard]] Result<Predictor> predictor_from(const std::string& name);

class Motion {
 public:
  explicit Motion(Predictor predictor) : predictor_(predictor) {}

  void add(const Eigen::Isometry3d& X, std::int64_t time_ns);
  void forget() { past_.clear(); }

  // Of the poses given, the last but one.
  std::optional<Eigen::Isometry3d> before_last() const;

  // The last pose if too little is known. Times may be uneven, and further ahead than one frame.
  Eigen::Isometry3d predict(std::int64_t time_ns) const { return predict(time_ns, predictor_); }
  Eigen::Isometry3d predict(std::int64_t time_ns, Predictor predictor) const;

 private:
  struct Moment {
    Eigen::Isometry3d X;
    std::int64_t time_ns;
  };
  Predictor predictor_;
  std::deque<Moment> past_;  // oldest first, at most three
};

}  // namespace counterpart
