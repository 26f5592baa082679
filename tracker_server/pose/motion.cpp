#include "tracker_server/pose/motion.hpp"

#include <algorithm>

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

struct Velocity {
  Vector3d linear = Vector3d::Zero();   // m/s
  Vector3d angular = Vector3d::Zero();  // rad/s
};

double seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace

Result<Predictor> predictor_from(const std::string& name) {
  if (name == "none") return Predictor::none;
  if (name == "first") return Predictor::first;
  if (name == "second") return Predictor::second;
  return failure(ErrorCode::invalid_argument, "\"" + name + "\" is no predictor; choose none, first or second.");
}

void Motion::add(const Isometry3d& X, std::int64_t time_ns) {
  if (!past_.empty() && time_ns <= past_.back().time_ns) past_.clear();
  past_.push_back({X, time_ns});
  if (past_.size() > 3) past_.pop_front();
}

std::optional<Isometry3d> Motion::before_last() const {
  if (past_.size() < 2) return std::nullopt;
  return past_[past_.size() - 2].X;
}

Isometry3d Motion::predict(std::int64_t time_ns, Predictor predictor) const {
  if (past_.empty()) return Isometry3d::Identity();
  const Moment& last = past_.back();
  if (predictor == Predictor::none || past_.size() < 2 || time_ns <= last.time_ns) return last.X;
  const auto velocity = [&](const Moment& a, const Moment& b) {
    const double dt = seconds(b.time_ns - a.time_ns);
    const Eigen::AngleAxisd turn(b.X.linear() * a.X.linear().transpose());
    return Velocity{(b.X.translation() - a.X.translation()) / dt, turn.axis() * turn.angle() / dt};
  };
  // A prediction far ahead would run away: after a few frames without a sight the motion is not what it was.
  const std::int64_t step_ns = last.time_ns - past_[past_.size() - 2].time_ns;
  const double dt = seconds(std::min(time_ns - last.time_ns, 3 * step_ns));
  Velocity v = velocity(past_[past_.size() - 2], last);
  if (predictor == Predictor::second && past_.size() == 3) {
    const Velocity before = velocity(past_[0], past_[1]);
    const double between = seconds(last.time_ns - past_[0].time_ns) / 2;
    // The mean velocity of the coming step lies half a step ahead of the last one's.
    const double ahead = 0.5 * (dt + seconds(step_ns));
    v.linear += (v.linear - before.linear) / between * ahead;
    v.angular += (v.angular - before.angular) / between * ahead;
  }
  Isometry3d X = last.X;
  const double angle = v.angular.norm() * dt;
  if (angle > 1e-12) X.linear() = Eigen::AngleAxisd(angle, v.angular.normalized()) * X.linear();
  X.translation() += v.linear * dt;
  return X;
}

}  // namespace counterpart
