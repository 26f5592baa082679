#include "tests/bench/game_suite/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace counterpart::bench {
namespace {

using stage::Event;
using stage::EventKind;
using stage::IllegalKind;
using stage::Scenario;

constexpr double kDegree = 0.017453292519943295;

// By hand, so that every standard library draws the same.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double from_to(double low, double high) {
    return low + static_cast<double>(engine_() >> 11) * 0x1p-53 * (high - low);
  }
  int whole(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double share) { return from_to(0, 1) < share; }
  double either_sign(double low, double high) { return (chance(0.5) ? 1 : -1) * from_to(low, high); }

 private:
  std::mt19937_64 engine_;
};

BoardGeometry draw_board(Dice& dice) {
  BoardGeometry board;
  board.squares = dice.chance(0.3) ? 8 : 10;
  board.square_size_m = board.squares == 8 ? dice.from_to(0.042, 0.052) : dice.from_to(0.036, 0.042);
  board.border_m = dice.from_to(0.012, 0.035);
  board.piece_radius_m = board.square_size_m * dice.from_to(0.37, 0.42);
  board.piece_height_m = dice.from_to(0.006, 0.011);
  if (dice.chance(0.25)) board.played_on = SquareColour::light;
  return board;
}

void draw_camera(Dice& dice, Scenario& s) {
  stage::CameraPath& path = s.path;
  path = {};
  path.eye_R = {dice.from_to(-0.25, 0.25), dice.from_to(0.72, 0.90), dice.from_to(0.60, 0.85)};
  path.target_R = {dice.from_to(-0.03, 0.03), dice.from_to(-0.16, -0.05), dice.from_to(0.02, 0.10)};
  path.shake_m = dice.from_to(0, 0.002);
  path.shake_rad = dice.from_to(0, 0.15) * kDegree;
  if (dice.chance(0.6)) path.orbit_rad = dice.from_to(2, 8) * kDegree;
  path.orbit_period_s = dice.from_to(10, 20);
  if (dice.chance(0.3)) path.dolly_to_R = path.eye_R * dice.from_to(0.9, 1.1);
  if (dice.chance(0.15)) {
    path.zoom_low = dice.from_to(0.92, 1);
    path.zoom_high = dice.from_to(1, 1.06);
  }
}

void draw_sensor(Dice& dice, Scenario& s) {
  s.light = dice.from_to(0.55, 1.1);
  s.sensor.noise = dice.from_to(1, 4);
  s.sensor.blur_px = dice.from_to(0.4, 0.9);
  if (dice.chance(0.5)) s.sensor.exposure_drift_ev = dice.from_to(0.1, 0.6);
  if (dice.chance(0.5)) s.sensor.white_drift = dice.from_to(0.02, 0.08);
  s.sensor.drift_period_s = dice.from_to(6, 20);
  if (dice.chance(0.3)) s.sensor.jpeg_quality = dice.whole(60, 92);
  if (dice.chance(0.06)) s.shutter.interlaced = true;
}

// Whether the whole board with its rim stays in the picture while nobody knocks against anything.
bool board_in_picture(const Scenario& s) {
  constexpr double margin_px = 12;
  const double half = s.board.squares * s.board.square_size_m / 2 + s.board.border_m;
  for (double t_s = 0; t_s < 20; t_s += 0.5) {
    View view{s.intrinsics, stage::camera_at_X_CR(s.path, t_s)};
    view.intrinsics.fx *= stage::zoom_at(s.path, t_s);
    view.intrinsics.fy = view.intrinsics.fx;
    for (const double x : {-half, half})
      for (const double y : {-half, half}) {
        const Eigen::Vector2d p = project(view, {x, y, 0});
        if (!(p.x() > margin_px && p.y() > margin_px && p.x() < s.intrinsics.width - margin_px &&
              p.y() < s.intrinsics.height - margin_px))
          return false;
      }
  }
  return true;
}

Event event_of(EventKind kind, double at_s, double for_s) {
  Event event;
  event.kind = kind;
  event.at_s = at_s;
  event.for_s = for_s;
  return event;
}

void draw_events(Dice& dice, Scenario& s, double length_s) {
  const auto some_time = [&] { return dice.from_to(3, length_s); };
  if (dice.chance(0.7)) {
    Event lights = event_of(EventKind::lights, some_time(), dice.from_to(1, 3));
    lights.level = dice.from_to(0.02, 0.5);
    s.events.push_back(lights);
  }
  if (dice.chance(0.6)) {
    Event nudge = event_of(EventKind::nudge_board, some_time(), dice.from_to(0.3, 0.6));
    nudge.by_m = {dice.either_sign(0.002, 0.008), dice.either_sign(0.002, 0.008)};
    nudge.turn_rad = dice.either_sign(0.5, 2) * kDegree;
    s.events.push_back(nudge);
  }
  if (dice.chance(0.6)) {
    Event bump = event_of(EventKind::bump_camera, some_time(), 1);
    bump.turn_rad = dice.either_sign(0.5, 1) * kDegree;
    s.events.push_back(bump);
  }
  if (dice.chance(0.5)) {
    Event cup = event_of(EventKind::cup, some_time(), dice.from_to(5, 20));
    const double beside_m = s.board.squares * s.board.square_size_m / 2 + s.board.border_m + 0.08;
    cup.by_m = {dice.either_sign(beside_m, beside_m + 0.06), dice.from_to(-0.1, 0.1)};
    s.events.push_back(cup);
  }
  if (dice.chance(0.5)) {
    Event away = event_of(EventKind::look_away, some_time(), dice.from_to(2, 4));
    away.turn_rad = dice.either_sign(30, 60) * kDegree;
    s.events.push_back(away);
  }
  if (dice.chance(0.25)) {
    Event defocus = event_of(EventKind::defocus, some_time(), dice.from_to(1, 3));
    defocus.blur_px = dice.from_to(0.8, 2);
    s.events.push_back(defocus);
  }
  if (dice.chance(0.2)) {
    Event cover = event_of(EventKind::cover, some_time(), dice.from_to(2, 5));
    cover.share = dice.from_to(0.3, 0.7);
    s.events.push_back(cover);
  }
}

void draw_player(Dice& dice, Scenario& s, int plies, double length_s) {
  stage::PlayerOptions& player = s.player;
  player.speed = dice.from_to(1.2, 2.4);
  const int his_moves = std::max(2, plies / 2);
  std::array<IllegalKind, 5> kinds{IllegalKind::backwards, IllegalKind::sideways, IllegalKind::too_far,
                                   IllegalKind::two_pieces, IllegalKind::wrong_piece};
  for (std::size_t i = kinds.size() - 1; i > 0; --i)
    std::swap(kinds[i], kinds[static_cast<std::size_t>(dice.whole(0, static_cast<int>(i)))]);
  const int illegal = dice.whole(2, 3);
  for (int i = 0; i < illegal; ++i)
    player.illegal_moves.push_back(
        {1 + (i * his_moves + dice.whole(0, his_moves - 1)) / illegal, kinds[static_cast<std::size_t>(i)]});
  if (dice.chance(0.6)) player.knocks_over.push_back(dice.whole(1, his_moves - 1));
  if (dice.chance(0.5)) player.forgets_s = dice.from_to(1, 5);
  if (dice.chance(0.6)) {
    // Now and then for as long as somebody who thinks hard.
    const double for_s = dice.chance(0.15) ? 20 : dice.from_to(2, 5);
    player.rests.push_back({dice.from_to(3, length_s), for_s, {dice.from_to(-0.12, 0.12), dice.from_to(-0.12, 0.12)}});
  }
}

}  // namespace

Scenario plan_game(std::uint64_t suite_seed, int number, int plies) {
  const std::uint64_t seed = suite_seed * 100'003 + static_cast<std::uint64_t>(number);
  Dice dice(seed);
  Scenario s;
  s.name = "game " + std::to_string(number) + " of seed " + std::to_string(suite_seed);
  s.board = draw_board(dice);
  // At the usual speed a move of each side takes about three seconds.
  const double length_s = 1.3 * plies;
  draw_camera(dice, s);
  for (int tries = 0; tries < 100 && !board_in_picture(s); ++tries) draw_camera(dice, s);
  if (!board_in_picture(s)) s.path = {};
  draw_sensor(dice, s);
  draw_events(dice, s, length_s);
  draw_player(dice, s, plies, length_s);
  stage::reseed(s, seed);
  return s;
}

}  // namespace counterpart::bench
