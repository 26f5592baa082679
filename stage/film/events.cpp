#include "stage/film/events.hpp"

#include <algorithm>
#include <cmath>

#include "stage/film/hidden.hpp"

namespace counterpart::stage {
namespace {

double eased(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// 0 before and after the event, 1 in it, with a change of `fade_s` at both ends.
double presence(const Event& event, double t_s, double fade_s) {
  return std::min(eased((t_s - event.at_s) / fade_s), eased((event.at_s + event.for_s - t_s) / fade_s));
}

constexpr double kPaper_m = 0.62;

Sheet paper_at(double left_m, double t_s) {
  Sheet sheet;
  sheet.size_x_m = sheet.size_y_m = kPaper_m;
  sheet.X_BS.translation() = Eigen::Vector3d(left_m + kPaper_m / 2, 0.01 * std::sin(0.7 * t_s), 0.06);
  sheet.X_BS.rotate(Eigen::AngleAxisd(0.06 * std::sin(0.9 * t_s), Eigen::Vector3d::UnitZ()));
  return sheet;
}

}  // namespace

void apply_events(const std::vector<Event>& events, double t_s, double light, World& world) {
  world.light = light;
  world.cup_R.reset();
  Eigen::Isometry3d X_RB = Eigen::Isometry3d::Identity();
  for (const Event& event : events) {
    if (event.kind == EventKind::lights) {
      world.light += (event.level - light) * presence(event, t_s, 0.12);
    } else if (event.kind == EventKind::nudge_board) {
      const double s = eased((t_s - event.at_s) / event.for_s);
      X_RB.pretranslate(Eigen::Vector3d(s * event.by_m.x(), s * event.by_m.y(), 0));
      X_RB.rotate(Eigen::AngleAxisd(s * event.turn_rad, Eigen::Vector3d::UnitZ()));
    } else if (event.kind == EventKind::cup) {
      const double there = presence(event, t_s, 0.9);
      if (there <= 0) continue;
      const double side = event.by_m.x() < 0 ? -1 : 1;
      world.cup_R = Eigen::Vector3d(event.by_m.x() + side * 0.9 * (1 - there), event.by_m.y(),
                                    0.12 * std::sin(3.14159265 * there) - world.board.thickness_m);
    }
  }
  if (!X_RB.isApprox(world.X_RB, 0)) move_board(world, X_RB);
}

Eigen::Isometry3d camera_turn(const std::vector<Event>& events, double t_s) {
  double yaw = 0, pitch = 0;
  for (const Event& event : events) {
    const double since = t_s - event.at_s;
    if (event.kind == EventKind::look_away) {
      yaw += event.turn_rad * presence(event, t_s, std::min(0.6, event.for_s / 2));
    } else if (event.kind == EventKind::bump_camera && since > 0) {
      const double swing = std::exp(-since / 0.25) * std::cos(2 * 3.14159265 * 4.5 * since);
      yaw += event.turn_rad * (1 - swing);
      pitch += 0.6 * event.turn_rad * std::exp(-since / 0.25) * std::sin(2 * 3.14159265 * 6.5 * since);
    }
  }
  return Eigen::Isometry3d(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()));
}

double defocus_px(const std::vector<Event>& events, double t_s) {
  double result = 0;
  for (const Event& event : events) {
    if (event.kind == EventKind::defocus) {
      result += event.blur_px * presence(event, t_s, std::min(0.5, event.for_s / 2));
    }
  }
  return result;
}

void cover_board(const std::vector<Event>& events, double t_s, const View& view, World& world) {
  world.sheet.reset();
  for (const Event& event : events) {
    const double wanted =
        event.kind == EventKind::cover ? event.share * presence(event, t_s, std::min(1.0, event.for_s / 2)) : 0;
    if (wanted <= 0) continue;
    double low = -0.5, high = 0.5;  // of the paper's left edge: the farther left, the more is hidden
    for (int i = 0; i < 12; ++i) {
      const double middle = (low + high) / 2;
      world.sheet = paper_at(middle, t_s);
      (hidden_shares(world, view).edges > wanted ? low : high) = middle;
    }
    return;
  }
}

}  // namespace counterpart::stage
