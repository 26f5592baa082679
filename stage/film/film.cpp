#include "stage/film/film.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "stage/film/hidden.hpp"
#include "vhd_renderer/body/character.hpp"

namespace counterpart::stage {

Film::Film(const Scenario& scenario, std::unique_ptr<SeatedBody> body, std::unique_ptr<Room> room)
    : scenario_(scenario),
      body_(std::move(body)),
      room_(std::move(room)),
      now_(starting_world(scenario.board)),
      player_(scenario.player) {
  now_.player_present = scenario.player_present;
  now_.light = scenario.light;
  if (scenario.no_pieces || scenario.no_board) now_.pieces.clear();
  now_.board_present = !scenario.no_board;
  set_scene(now_, 0);
  if (body_) body_->pass(0, now_);
  world_ = now_;
}

Result<Film> Film::begin(const Scenario& scenario) {
  std::unique_ptr<SeatedBody> body;
  std::string warning;
  if (scenario.player_present && !scenario.player_figure.empty()) {
    Result<std::unique_ptr<SeatedBody>> seated = SeatedBody::seat(scenario.player_figure, scenario.board);
    if (!seated && ready_characters().count(scenario.player_figure) > 0) {
      warning = seated.error().message + "; the mannequin sits there instead";
      seated = SeatedBody::seat("mannequin", scenario.board);
    }
    if (!seated) return tl::make_unexpected(seated.error());
    body = *std::move(seated);
  }
  RoomOptions options;
  options.body = body.get();
  options.width = scenario.intrinsics.width;
  options.height = scenario.intrinsics.height;
  options.board = scenario.board;
  options.objects = scenario.objects;
  options.warp_m = scenario.warp_m;
  options.warp_seed = scenario.seed;
  const auto& dist = scenario.intrinsics.dist;
  options.fine = std::any_of(dist.begin(), dist.end(), [](double k) { return k != 0; });
  Result<std::unique_ptr<Room>> room = Room::furnish(options);
  if (!room) return tl::make_unexpected(room.error());
  Film film(scenario, std::move(body), std::move(*room));
  film.warning_ = warning;
  return film;
}

View Film::view_at(double t_s, const World& world) const {
  View view{scenario_.intrinsics, Eigen::Isometry3d::Identity()};
  if (const double zoom = zoom_at(scenario_.path, t_s); zoom != 1) {
    view.intrinsics.fx *= zoom;
    view.intrinsics.fy *= zoom;
    view.intrinsics.id = static_cast<std::uint32_t>(next_frame_) + 2;
  }
  view.X_CB = camera_turn(scenario_.events, t_s) * camera_at_X_CR(scenario_.path, t_s) * world.X_RB;
  return view;
}

void Film::set_scene(World& world, double t_s) const {
  apply_events(scenario_.events, t_s, scenario_.light, world);
  world.objects.clear();
  for (const ObjectPlan& plan : scenario_.objects) {
    world.objects.push_back(object_at(plan, -scenario_.board.thickness_m, t_s));
  }
}

void Film::pass_until(double t_s) {
  if (t_s > now_s_) {
    player_.step(t_s - now_s_, now_);
    now_s_ = t_s;
    if (body_) body_->pass(t_s, now_);
  }
  set_scene(now_, t_s);
}

namespace {

// A part of the exposure: when, and which rows it lights.
struct Part {
  double after_stamp_s = 0;
  cv::Rect rows;
  int first_row = 0, row_step = 1;
};

std::vector<Part> parts_of(const Shutter& shutter, double period_s, const cv::Size& size) {
  constexpr int kSlices = 18;
  const int samples = shutter.open_s > 0 ? shutter.samples : 1;
  const int slices = shutter.interlaced ? 2 : shutter.readout_s > 0 ? kSlices : 1;
  std::vector<Part> parts;
  for (int slice = 0; slice < slices; ++slice) {
    Part part{0, cv::Rect({0, 0}, size), 0, 1};
    double middle_s = 0;
    if (shutter.interlaced) {
      middle_s = (slice - 0.5) * period_s / 2;
      part.first_row = slice;
      part.row_step = 2;
    } else if (slices > 1) {
      const int top = slice * size.height / slices;
      const int bottom = (slice + 1) * size.height / slices;
      part.rows = {0, top, size.width, bottom - top};
      middle_s = shutter.readout_s * ((top + bottom) / (2.0 * size.height) - 0.5);
    }
    for (int i = 0; i < samples; ++i) {
      part.after_stamp_s = middle_s + shutter.open_s * ((i + 0.5) / samples - 0.5);
      parts.push_back(part);
    }
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.after_stamp_s < b.after_stamp_s; });
  return parts;
}

}  // namespace

cv::Mat Film::expose_frame(double t_s) {
  const cv::Size size(scenario_.intrinsics.width, scenario_.intrinsics.height);
  const std::vector<Part> parts = parts_of(scenario_.shutter, 1 / scenario_.fps, size);
  if (parts.size() == 1) return room_->picture(world_, view_);
  // Light adds up, and the picture's numbers are square roots of light.
  cv::Mat light(size, CV_32FC3, cv::Scalar::all(0));
  World world = world_;
  bool middle_passed = false;
  for (const Part& part : parts) {
    const double at_s = t_s + part.after_stamp_s;
    if (part.after_stamp_s > -1e-12 && !middle_passed) {
      const std::optional<Sheet> sheet = world_.sheet;
      pass_until(t_s);
      world_ = now_;
      world_.sheet = sheet;
      middle_passed = true;
    }
    pass_until(at_s);
    world = now_;
    world.sheet = world_.sheet;
    const cv::Mat picture = room_->picture(world, view_at(at_s, world), part.rows);
    for (int row = part.rows.y + part.first_row; row < part.rows.br().y; row += part.row_step) {
      cv::Mat some, sum = light.row(row);
      picture.row(row).convertTo(some, CV_32FC3);
      cv::accumulateSquare(some, sum);
    }
  }
  const int samples = scenario_.shutter.open_s > 0 ? scenario_.shutter.samples : 1;
  cv::sqrt(light / samples, light);
  cv::Mat bgr;
  light.convertTo(bgr, CV_8UC3);
  return bgr;
}

Shot Film::next() {
  const double t_s = static_cast<double>(next_frame_) / scenario_.fps;
  const View before = view_;
  const bool partial = scenario_.shutter.open_s > 0 || scenario_.shutter.readout_s > 0 || scenario_.shutter.interlaced;
  if (!partial) pass_until(t_s);
  world_ = now_;
  if (partial) set_scene(world_, t_s);
  view_ = view_at(t_s, world_);
  cover_board(scenario_.events, t_s, view_, world_);

  Shot shot;
  shot.image_bgr = expose_frame(t_s);
  SensorOptions sensor = scenario_.sensor;
  sensor.blur_px = std::hypot(sensor.blur_px, defocus_px(scenario_.events, t_s));
  expose(shot.image_bgr, sensor, scenario_.seed, next_frame_, drift_gain(sensor, t_s));
  Truth& truth = shot.truth;
  truth.stamp = {next_frame_, std::llround(t_s * 1e9)};
  truth.view = view_;
  truth.board = scenario_.board;
  truth.occupancy = occupancy_of(world_);
  truth.holds_piece = world_.hand.held_piece >= 0;
  const Hidden hidden = hidden_shares(world_, view_);
  truth.hand_share = hidden.surface_by_arm;
  truth.edges_hidden = hidden.edges;
  truth.board_present = world_.board_present;
  for (std::size_t i = 0; i < world_.objects.size(); ++i) {
    truth.objects.push_back({world_.objects[i].name, view_.X_CB * world_.X_RB.inverse() * world_.objects[i].X_RO,
                             object_edges_hidden(world_, i, view_)});
  }
  if (next_frame_ > 0) {
    const double half = scenario_.board.squares * scenario_.board.square_size_m / 2;
    for (const double x : {-half, half}) {
      for (const double y : {-half, half}) {
        truth.motion_px += (project(view_, {x, y, 0}) - project(before, {x, y, 0})).norm() / 4;
      }
    }
  }
  ++next_frame_;
  return shot;
}

void Film::skip() {
  const double t_s = static_cast<double>(next_frame_) / scenario_.fps;
  pass_until(t_s);
  world_ = now_;
  view_ = view_at(t_s, world_);
  ++next_frame_;
}

cv::Mat Film::arm_mask() {
  return room_->arm_mask(world_, view_);
}

}  // namespace counterpart::stage
