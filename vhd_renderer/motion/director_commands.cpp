#include <algorithm>
#include <cmath>
#include <tuple>

#include "protocol/vocabulary/pose_eigen.hpp"
#include "vhd_renderer/motion/director_state.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Isometry3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr double farthest_m = 20;        // no place of a room is farther from the board
constexpr std::size_t most_points = 64;  // of a path
constexpr float tolerated_gap_m = 0.003F;

bool finite(const Point3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

bool near_enough(const Point3& p) {
  return std::abs(p[0]) < farthest_m && std::abs(p[1]) < farthest_m && std::abs(p[2]) < farthest_m;
}

std::string path_trouble(const std::vector<Point3>& path) {
  if (path.size() > most_points) return "too_long";
  for (const Point3& p : path) {
    if (!finite(p)) return "not_a_number";
    if (!near_enough(p)) return "out_of_reach";
  }
  return {};
}

unsigned parts_of(BodyPart p) {
  switch (p) {
    case BodyPart::upper:
      return part::head | part::arms | part::trunk | part::face;
    case BodyPart::head:
      return part::head;
    case BodyPart::left_arm:
      return part::left_arm;
    case BodyPart::right_arm:
      return part::right_arm;
    case BodyPart::face:
      return part::face;
    case BodyPart::legs:
      return part::legs;
    case BodyPart::whole:
      break;
  }
  return ~0U;
}

std::string grasp_trouble(const Grasp& g) {
  if (g.path_B.empty()) return "no_path";
  if (!std::isfinite(g.duration_s) || g.duration_s < 0) return "not_a_number";
  if (g.duration_s > 0 && (g.duration_s < 1.0 || g.duration_s > 60)) return "bad_duration";
  const bool points = g.style == "point" && g.piece.empty();
  if (!g.style.empty() && g.style != "slam" && g.style != "hesitant" && !points) return "unknown_style";
  if (g.hand != Hand::any && g.hand != Hand::left && g.hand != Hand::right) return "unknown_hand";
  return path_trouble(g.path_B);
}

std::string keyframe_trouble(const Keyframe& k, const ClipLibrary& library) {
  const auto clip = library.find(k.clip);
  if (clip == library.end()) return "unknown_clip";
  if (!std::isfinite(k.speed) || !std::isfinite(k.weight)) return "not_a_number";
  if (k.speed < 0.1 || k.speed > 5) return "bad_speed";
  if (k.weight < 0 || k.weight > 1) return "bad_weight";
  if ((clip->second.parts() & parts_of(k.part)) == 0) return "no_such_part";
  return {};
}

std::string navigate_trouble(const Navigate& n) {
  if (!std::isfinite(n.heading_rad)) return "not_a_number";
  if (!n.gait.empty() && n.gait != "walk" && n.gait != "hurry" && n.gait != "instant") return "unknown_gait";
  if (n.place.empty()) return n.path_B.empty() ? "no_path" : path_trouble(n.path_B);
  const bool known = n.place == "entrance" || n.place == "chair" || n.place == "seat" || n.place == "away";
  return known ? "" : "unknown_place";
}

}  // namespace

PieceOnStage* Director::State::find_piece(const std::string& name) {
  for (PieceOnStage& piece : pieces) {
    if (piece.piece.name == name) return &piece;
  }
  return nullptr;
}

Needs Director::State::needs_of(const Command& command) const {
  if (const auto* g = std::get_if<Grasp>(&command.action)) {
    const unsigned arm = g->hand == Hand::left ? part::left_arm : g->hand == Hand::right ? part::right_arm : part::arms;
    return {arm, part::legs, g->hand == Hand::any};
  }
  if (const auto* k = std::get_if<Keyframe>(&command.action)) {
    const auto clip = library.find(k->clip);
    return {clip == library.end() ? 0 : clip->second.parts() & parts_of(k->part), 0, false};
  }
  if (std::holds_alternative<Navigate>(command.action)) return {part::legs | part::arms, 0, false};
  if (std::holds_alternative<Gaze>(command.action)) return {part::gaze, 0, false};
  if (std::holds_alternative<Say>(command.action)) return {part::voice, 0, false};
  if (std::holds_alternative<Express>(command.action)) return {part::face, 0, false};
  return {};
}

std::string Director::State::why_not(const Command& command) const {
  if (!has_body) return "no_skeleton";
  if (command.delay_ms < 0 || command.deadline_ms < 0 || command.delay_ms > 86'400'000) return "bad_time";
  if (command.after.size() > 1000) return "too_long";
  if (std::find(command.after.begin(), command.after.end(), command.id) != command.after.end()) return "after_itself";
  if (const auto* g = std::get_if<Grasp>(&command.action)) return grasp_trouble(*g);
  if (const auto* k = std::get_if<Keyframe>(&command.action)) return keyframe_trouble(*k, library);
  if (const auto* n = std::get_if<Navigate>(&command.action)) return navigate_trouble(*n);
  if (const auto* e = std::get_if<Express>(&command.action)) {
    if (!std::isfinite(e->weight) || !std::isfinite(e->hold_s)) return "not_a_number";
    return face_of(e->face) == nullptr ? "unknown_face" : e->weight < 0 || e->weight > 1 ? "bad_weight" : "";
  }
  if (const auto* s = std::get_if<Say>(&command.action)) return s->text.size() > 4000 ? "too_long" : "";
  if (const auto* g = std::get_if<Gaze>(&command.action)) {
    if (!std::isfinite(g->hold_s) || !finite(g->point_B)) return "not_a_number";
    if (g->target == GazeTarget::square && !is_square(g->square, scene.board.squares)) return "unknown_square";
  }
  return {};
}

void Director::State::submit(const Command& command) {
  if (const Feedback* last = queue.said_before(command.id); last != nullptr) {
    const Feedback again = *last;
    queue.repeat(again);
    return;
  }
  if (const std::string code = why_not(command); !code.empty()) {
    queue.refuse(command, code, -1, now_ns);
    return;
  }
  if (const auto* s = std::get_if<Stop>(&command.action);
      s != nullptr && command.after.empty() && command.delay_ms == 0) {
    queue.accept(command, {}, now_ns);
    stop(*s, command.id);
    queue.end(command.id, FeedbackState::finished, "", -1, now_ns);
    return;
  }
  const Needs needs = needs_of(command);
  if (command.interrupt) {
    for (const std::uint64_t id : queue.in_the_way(needs)) cancel(id);
  }
  queue.accept(command, needs, now_ns);
}

void Director::State::start(CommandQueue::Entry& entry, unsigned free_parts) {
  const std::uint64_t id = entry.command.id;
  const Action& action = entry.command.action;
  if (const auto* g = std::get_if<Grasp>(&action)) {
    start_grasp(entry, *g, free_parts);
  } else if (const auto* k = std::get_if<Keyframe>(&action)) {
    const Clip& clip = library.at(k->clip);
    const unsigned mask = clip.parts() & parts_of(k->part);
    // Whoever thinks has his hands free for what he is told to do.
    if (clip.yields) entry.needs.own &= ~part::arms;
    clips.push_back({id, ++sources, &clip, *k, mask, now_s, -1,
                     clip.yields && k->part == BodyPart::whole ? next_variation() : ClipVariation{}});
  } else if (const auto* n = std::get_if<Navigate>(&action)) {
    start_navigation(id, *n);
  } else if (const auto* z = std::get_if<Gaze>(&action)) {
    if (z->target == GazeTarget::piece && find_piece(z->piece) == nullptr) {
      queue.end(id, FeedbackState::failed, "unknown_piece", -1, now_ns);
    } else {
      gaze = RunningGaze{id, *z, now_s};
    }
  } else if (const auto* s = std::get_if<Say>(&action)) {
    speech = RunningSpeech{id, *s, speaker ? speaker(s->text, s->language) : ready_sound(nullptr), now_s, {}, {}, 0};
  } else if (const auto* e = std::get_if<Express>(&action)) {
    face = RunningFace{id, *e, now_s};
  } else if (const auto* p = std::get_if<Stop>(&action)) {
    const Stop what = *p;
    stop(what, id);
    queue.end(id, FeedbackState::finished, "", -1, now_ns);
  }
}

// The way the hand is turned at a place: as near to a person's habit as the neighbours let the open fingers, and the
// wrist the hand.
float Director::State::clear_heading(std::size_t side, const Vector3f& foot_S, const std::string& moved) {
  const auto radius = static_cast<float>(scene.board.piece_radius_m);
  const auto height = static_cast<float>(scene.board.piece_height_m);
  std::vector<std::pair<Vector3f, float>> neighbours;  // place from the piece, height
  for (const PieceOnStage& piece : pieces) {
    const Vector3f from = piece.foot_S - foot_S;
    if (piece.piece.name == moved || from.norm() > 0.13F || from.head<2>().norm() < radius) continue;
    neighbours.emplace_back(from, height * (piece.piece.king ? 2 : 1));
  }
  const Grip& grip = grips[side];
  const auto clearance = [&](float heading) {
    const AngleAxisf turn(heading + pi_f / 2, Vector3f::UnitZ());
    float least = 1;
    for (const Vector3f& p_P : grip.open_skin_P) {
      if (p_P.z() > 2 * height) continue;
      const Vector3f p = turn * p_P;
      for (const auto& [from, tall] : neighbours) {
        if (p.z() < from.z() + tall) least = std::min(least, (p - from).head<2>().norm() - radius);
      }
    }
    return least;
  };
  const auto gap = [&](float heading) {
    return actor->reach_gap_m(side, holding(grip.X_WP, {foot_S, heading}, grip.closed));
  };
  constexpr float enough_m = 0.002F;
  constexpr float slack_m = 0.0003F;
  const float natural = natural_heading(side, foot_S);
  float best = natural;
  float best_score = -1e9F;
  for (int step = 0; step <= 16; ++step) {
    for (const float sign : {1.F, -1.F}) {
      const float heading = natural + sign * radians(5) * static_cast<float>(step);
      if (std::abs(heading) > radians(55)) continue;
      const float free = std::min(clearance(heading), enough_m);
      if (free <= best_score) continue;
      const float score = free - gap(heading);
      if (score >= enough_m - slack_m) return heading;
      if (score <= best_score) continue;
      best_score = score;
      best = heading;
    }
  }
  return best;
}

void Director::State::set_headings(GraspTask& task, const std::string& moved) {
  const auto heading = [&](const Vector3f& foot_S) {
    return task.touch_only ? natural_heading(task.side, foot_S) : clear_heading(task.side, foot_S, moved);
  };
  task.from.heading_rad = heading(task.from.foot_S);
  for (GraspPoint& point : task.path) point.heading_rad = heading(point.foot_S);
}

// The task for the hand that comes nearest to every point of it, each with the way the hand is turned there; how near.
std::pair<GraspTask, float> Director::State::with_best_hand(const std::vector<std::size_t>& hands,
                                                            const GraspTask& task, const std::string& moved) {
  std::pair<GraspTask, float> best{task, 1e9F};
  for (const std::size_t s : hands) {
    GraspTask own = task;
    own.side = s;
    set_headings(own, moved);
    const Isometry3f X_WP = task.touch_only
                                ? touch_frame(*figure, anatomy.arms[s].hand, hand_shape("point"), grips[s].X_WP)
                                : grips[s].X_WP;
    std::vector<GraspPoint> points = own.path;
    points.push_back(own.from);
    float gap = 0;
    for (const GraspPoint& point : points) {
      gap = std::max(gap, actor->reach_gap_m(s, holding(X_WP, point, grips[s].closed)));
    }
    if (gap < best.second - 1e-3F) best = {std::move(own), gap};
    if (gap <= tolerated_gap_m) break;
  }
  return best;
}

// What he does only while he has nothing to do ends when he has.
void Director::State::end_idle_clips() {
  for (RunningClip& clip : clips) {
    if (clip.clip->yields && clip.fade_from_s < 0) clip.fade_from_s = now_s;
  }
}

// No two of them in a row alike.
ClipVariation Director::State::next_variation() {
  const unsigned n = variations++;
  const auto jitter = [n](unsigned seed) { return noise(static_cast<double>(n), seed); };
  ClipVariation v;
  v.mirrored = n % 3 == 2;
  v.hands = n % 3 != 1;
  v.head = {radians(2.5F) * jitter(71), radians(3) * jitter(72), radians(4) * jitter(73)};
  v.place = Vector3f(jitter(74), 0.4F * jitter(75), jitter(76)) * 0.012F;
  return v;
}

void Director::State::start_grasp(CommandQueue::Entry& entry, const Grasp& grasp, unsigned free_parts) {
  const std::uint64_t id = entry.command.id;
  GraspTask task;
  task.style = grasp.style;
  task.duration_s = grasp.duration_s;
  task.touch_only = grasp.piece.empty();
  for (const Point3& p : grasp.path_B) task.path.push_back({S_from_B(p), 0});
  if (!task.touch_only) {
    const PieceOnStage* piece = find_piece(grasp.piece);
    if (piece == nullptr) return queue.end(id, FeedbackState::failed, "unknown_piece", -1, now_ns);
    if (piece->piece.real) return queue.end(id, FeedbackState::failed, "real_piece", -1, now_ns);
    for (const auto& other : grasps) {
      if (other && other->piece == grasp.piece) return queue.end(id, FeedbackState::failed, "piece_in_use", -1, now_ns);
    }
    task.from.foot_S = piece->foot_S;
  } else {
    task.from = task.path.back();
  }

  // The hand that is asked for; else the right one, unless the whole move lies on the left or it does not reach.
  std::vector<std::size_t> hands;
  const bool left_side_move =
      std::all_of(task.path.begin(), task.path.end(), [](const GraspPoint& p) { return p.foot_S.x() < -0.09F; }) &&
      task.from.foot_S.x() < -0.09F;
  for (const std::size_t s : left_side_move ? std::array<std::size_t, 2>{left_side, right_side}
                                            : std::array<std::size_t, 2>{right_side, left_side}) {
    const unsigned bit = s == left_side ? part::left_arm : part::right_arm;
    if ((entry.needs.own & free_parts & bit) != 0) hands.push_back(s);
  }
  const float tallest = 2 * static_cast<float>(scene.board.piece_height_m);
  task.clearance_m = tallest + 0.014F;
  auto [own, gap] = with_best_hand(hands, task, grasp.piece);
  // To point at something one need not reach it.
  const Vector3f aim_S = task.from.foot_S;
  for (int tenths = 1; task.style == "point" && gap > tolerated_gap_m && tenths < 8; ++tenths) {
    task.from.foot_S = aim_S + (Vector3f(0, -0.15F, 0.15F) - aim_S) * (0.1F * static_cast<float>(tenths));
    task.path = {task.from};
    std::tie(own, gap) = with_best_hand(hands, task, grasp.piece);
  }
  if (gap > tolerated_gap_m) {
    return queue.end(id, FeedbackState::failed, "out_of_reach", 1000.0 * static_cast<double>(gap), now_ns);
  }
  const std::size_t best = own.side;
  entry.needs = {best == left_side ? part::left_arm : part::right_arm, part::legs, false};
  end_idle_clips();
  GraspMotion motion(own, grips[best], *figure, anatomy.arms[best].hand, actor->arm(best), actor->rest(best));
  grasps[best] =
      RunningGrasp{id, ++sources, grasp.piece, std::move(motion), now_s, GraspPhase::done, false, false, 0, -1};
}

// Table, boxes and whatever else reaches from near the floor up into his way.
std::vector<Footprint> Director::State::obstacles() const {
  const Home& home = actor->home();
  std::vector<Footprint> found;
  bool table_known = false;
  for (const SceneBox& box : scene.boxes) {
    table_known = table_known || box.name == "table";
    const Isometry3f X_BO = to_eigen(box.X_BO).cast<float>();
    const Vector3f half = to_eigen(box.size_m).cast<float>() / 2;
    const float tall = X_BO.linear().row(2).cwiseAbs().dot(half);
    const float low = X_BO.translation().z() - tall - home.floor_z;
    const float high = X_BO.translation().z() + tall - home.floor_z;
    if (low > 1.9F || high < 0.08F) continue;
    const Vector3f x = X_BO.linear().col(0);
    const float turn = std::atan2(x.y(), x.x()) + (dark ? pi_f : 0.F);
    found.push_back({turned(X_BO.translation()).head<2>(), half.head<2>(), turn});
  }
  if (!table_known) {
    constexpr float usual_half_width_m = 0.65F;
    found.push_back({{0, 0}, {usual_half_width_m, -home.table_edge_y}, 0});
  }
  return found;
}

// From a place through points to another, round the obstacles between each two; nothing if there is no way.
std::optional<std::vector<Vector2f>> Director::State::way_through(const Vector2f& from,
                                                                  const std::vector<Vector2f>& through,
                                                                  const Vector2f& to) const {
  const std::vector<Footprint> things = obstacles();
  std::vector<Vector2f> stations = through;
  stations.push_back(to);
  std::vector<Vector2f> way;
  Vector2f at = from;
  for (const Vector2f& station : stations) {
    const auto round = way_round(at, station, things);
    if (!round) return std::nullopt;
    way.insert(way.end(), round->begin(), round->end());
    way.push_back(station);
    at = station;
  }
  way.pop_back();
  return way;
}

void Director::State::start_navigation(std::uint64_t id, const Navigate& n) {
  const Home& home = actor->home();
  const bool to_seat = n.place == "seat";
  Place end = n.place == "entrance" ? home.entrance : n.place == "away" ? home.away : home.chair;
  std::vector<Vector2f> through;
  if (n.place.empty()) {
    for (const Point3& p : n.path_B) through.push_back(S_from_B(p).head<2>());
    end = {through.back(), wrap_angle(static_cast<float>(n.heading_rad) - pi_f / 2 - (dark ? pi_f : 0))};
    through.pop_back();
  }
  const bool seated = actor->posture() == Posture::seated;
  if (seated && to_seat) return queue.end(id, FeedbackState::finished, "", -1, now_ns);

  if (n.gait == "instant") {
    actor->appear(end, to_seat ? Posture::seated : Posture::standing, now_s);
    return queue.end(id, FeedbackState::finished, "", -1, now_ns);
  }
  std::deque<Stretch> stretches;
  Place from = actor->place();
  if (seated) {
    stretches.push_back(Stretch::get_up(home, anatomy));
    from = home.chair;
  }
  // Between chair and table there is only the way from the side.
  const Vector2f beside(home.chair.p_S.x() + 0.62F, home.chair.p_S.y() - 0.04F);
  const auto at_chair = [&](const Place& p) { return (p.p_S - home.chair.p_S).norm() < 0.3F; };
  if (!at_chair(from) && at_chair(end)) through.push_back(beside);
  if (at_chair(from) && !at_chair(end)) through.insert(through.begin(), beside);
  WalkStyle style;
  if (n.gait == "hurry") {
    style.speed_m_s = 1.6F;
    style.step_m = 0.62F;
  }
  const auto way = way_through(from.p_S, through, end.p_S);
  if (!way) return queue.end(id, FeedbackState::failed, "in_the_way", -1, now_ns);
  through = *way;
  const bool moves = (from.p_S - end.p_S).norm() > 0.03F || !through.empty() ||
                     std::abs(wrap_angle(from.heading_rad - end.heading_rad)) > 0.05F;
  if (moves) stretches.push_back(Stretch::walk(Walk(from, through, end, style, anatomy)));
  if (to_seat) stretches.push_back(Stretch::sit_down(home, anatomy));
  if (stretches.empty()) return queue.end(id, FeedbackState::finished, "", -1, now_ns);
  end_idle_clips();
  navigating = id;
  going_phase.clear();
  actor->go(std::move(stretches), end, to_seat ? Posture::seated : Posture::standing, now_s);
}

unsigned Director::State::held_parts() const {
  unsigned held = 0;
  for (const std::size_t s : {left_side, right_side}) {
    if (grasps[s] && grasps[s]->id == 0) held |= s == left_side ? part::left_arm : part::right_arm;
  }
  if (actor && actor->going() && navigating == 0) held |= part::legs | part::arms;
  return held;
}

void Director::State::cancel_body(std::uint64_t id) {
  for (const std::size_t s : {left_side, right_side}) {
    auto& grasp = grasps[s];
    if (!grasp || grasp->id != id) continue;
    grasp->id = 0;
    const GraspMoment moment = grasp->motion.at(now_s - grasp->start_s);
    if (moment.phase == GraspPhase::reach) {
      grasp.reset();  // the arm's channel takes it home
      continue;
    }
    if (moment.phase != GraspPhase::carry && moment.phase != GraspPhase::close) continue;  // it finishes by itself
    // What is in the hand goes back to where it was taken.
    GraspTask back = grasp->motion.task();
    back.duration_s = 0;
    back.style.clear();
    const GraspPoint origin = back.from;
    if (moment.phase == GraspPhase::carry) back.from = {moment.held_S, moment.heading_rad};
    back.path = {origin};
    const bool touch = back.touch_only;
    GraspMotion motion(back, grips[s], *figure, anatomy.arms[s].hand, actor->arm(s), actor->rest(s));
    if (touch) {
      grasp.reset();
      continue;
    }
    const bool holding_now = moment.phase == GraspPhase::carry;
    grasp->start_s = now_s - motion.start_of(holding_now ? GraspPhase::carry : GraspPhase::retract);
    grasp->settled = !holding_now;
    grasp->motion = std::move(motion);
    grasp->source = ++sources;
  }
  for (RunningClip& clip : clips) {
    if (clip.id != id) continue;
    clip.id = 0;
    clip.fade_from_s = now_s;
  }
  if (gaze && gaze->id == id) gaze.reset();
  if (face && face->id == id) face.reset();
  if (speech && speech->id == id) speech.reset();
  if (navigating == id) navigating = 0;  // the stretch under way is finished: nobody can stop on one leg
}

void Director::State::cancel(std::uint64_t id) {
  if (queue.is_running(id)) cancel_body(id);
  queue.end(id, FeedbackState::cancelled, "", -1, now_ns);
}

void Director::State::stop(const Stop& what, std::uint64_t own_id) {
  for (const std::uint64_t id : what.commands.empty() ? queue.ids() : what.commands) {
    if (id != own_id) cancel(id);
  }
  if (what.commands.empty()) {
    gaze.reset();
    face.reset();
    speech.reset();
  }
}

}  // namespace counterpart
