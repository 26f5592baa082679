#include "tests/vhd_renderer/motion/human_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vhd_renderer/motion/clip.hpp"

namespace counterpart {
namespace {

using Eigen::Vector3f;

constexpr float degrees_per_radian = 180.F / std::numbers::pi_v<float>;

bool starts_with_one_of(const std::string& name, const std::vector<std::string>& starts) {
  return std::any_of(starts.begin(), starts.end(), [&](const std::string& s) { return name.rfind(s, 0) == 0; });
}

std::string side_of(Hand hand) {
  return hand == Hand::left ? "l_" : "r_";
}

std::vector<std::string> hand_joints(const std::string& side) {
  std::vector<std::string> names;
  for (const char* part : {"wrist", "thumb", "index", "middle", "ring", "pinky"}) names.push_back(side + part);
  return names;
}

std::string phase(const Rehearsal& r, std::uint64_t id) {
  const auto found = r.said.find(id);
  return found == r.said.end() ? "" : found->second.back().phase;
}

void look_at_carried(const Rehearsal& r, const BoardGeometry& board, const Figure& hand,
                     const std::array<Figure, 3>& fingers, GraspFigures& worst) {
  const Vector3f foot = r.piece("light_1");
  for (const Vector3f& p : skin_places(hand, r)) {
    worst.deepest_mm = std::max(worst.deepest_mm, -1000 * distance_to_piece(p, foot, board));
    worst.below_board_mm = std::max(worst.below_board_mm, -1000 * p.z());
  }
  for (std::size_t f = 0; f < 3; ++f) {
    float nearest = 1;
    for (const Vector3f& p : skin_places(fingers[f], r)) {
      nearest = std::min(nearest, distance_to_piece(p, foot, board));
    }
    worst.widest_gap_mm[f] = std::max(worst.widest_gap_mm[f], 1000 * nearest);
  }
}

Scene crowded_board(std::map<int, std::string>& light_at) {
  std::vector<std::pair<std::string, int>> men;
  for (int square = 31; square <= 50; ++square) men.emplace_back("light_" + std::to_string(square), square);
  for (const auto& [name, square] : men) light_at[square] = name;
  Scene scene = board_with(men);
  for (int square = 1; square <= 20; ++square) {
    const bool king = square % 7 == 4;
    scene.pieces.push_back(
        {"dark_" + std::to_string(square), Side::dark, king, true, centre_of_square_B(square, scene.board)});
  }
  return scene;
}

// Feet of everything that stands on the board but one piece; a king is two.
std::vector<Vector3f> feet_but(const Rehearsal& r, const Scene& scene, const std::string& moved) {
  std::vector<Vector3f> feet;
  const auto height = static_cast<float>(scene.board.piece_height_m);
  for (const StagedPiece& p : r.last.pieces) {
    if (p.name != moved) feet.emplace_back(p.X_BP.translation());
  }
  for (const ScenePiece& p : scene.pieces) {
    if (!p.real) continue;
    feet.emplace_back(static_cast<float>(p.p_B[0]), static_cast<float>(p.p_B[1]), static_cast<float>(p.p_B[2]));
    if (p.king) feet.emplace_back(feet.back() + Vector3f(0, 0, height));
  }
  return feet;
}

// A joint and all that hang on it.
std::vector<std::string> names_from(const Figure& figure, const std::string& top) {
  std::vector<std::string> names;
  std::vector<bool> inside(figure.joints.size(), false);
  for (std::size_t j = 0; j < figure.joints.size(); ++j) {
    const int parent = figure.joints[j].parent;
    inside[j] = figure.joints[j].name == top || (parent >= 0 && inside[at(parent)]);
    if (inside[j]) names.push_back(figure.joints[j].name);
  }
  return names;
}

Command navigate(std::uint64_t id, const std::string& place, const std::vector<Point3>& path = {},
                 const std::string& gait = "walk") {
  Command c;
  c.id = id;
  c.action = Navigate{place, path, 0, gait};
  return c;
}

}  // namespace

float distance_to_piece(const Vector3f& p, const Vector3f& foot, const BoardGeometry& board) {
  const float out = (p - foot).head<2>().norm() - static_cast<float>(board.piece_radius_m);
  const float z = p.z() - foot.z();
  const float up = std::max(-z, z - static_cast<float>(board.piece_height_m));
  if (out <= 0 || up <= 0) return std::max(out, up);
  return std::hypot(out, up);
}

Figure flesh_of(const Figure& figure, const std::vector<std::string>& joint_starts) {
  Figure flesh;
  flesh.joints = figure.joints;
  for (const FigurePart& whole : figure.parts) {
    FigurePart part;
    for (std::size_t v = 0; v < whole.positions_m.size(); ++v) {
      float weight = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (starts_with_one_of(figure.joints[whole.joints[v][k]].name, joint_starts)) weight += whole.weights[v][k];
      }
      if (weight < 0.5F) continue;
      part.positions_m.push_back(whole.positions_m[v]);
      part.normals.push_back(whole.normals[v]);
      part.joints.push_back(whole.joints[v]);
      part.weights.push_back(whole.weights[v]);
    }
    flesh.parts.push_back(std::move(part));
  }
  return flesh;
}

Figure scaled(Figure figure, float scale) {
  for (Joint& joint : figure.joints) {
    joint.X_PJ.translation() *= scale;
    joint.X_HJ.translation() *= scale;
  }
  for (FigurePart& part : figure.parts) {
    for (Vector3f& p : part.positions_m) p *= scale;
    for (Morph& morph : part.morphs) {
      for (Vector3f& offset : morph.offsets_m) offset *= scale;
    }
  }
  return figure;
}

std::vector<Vector3f> skin_places(const Figure& flesh, const Rehearsal& rehearsal) {
  std::vector<SkinnedPart> parts;
  skin(flesh, rehearsal.director.morph_names(), rehearsal.last, parts);
  std::vector<Vector3f> places;
  for (const SkinnedPart& part : parts) places.insert(places.end(), part.positions_m.begin(), part.positions_m.end());
  return places;
}

BodyPose shown_pose(const Figure& figure, const Performance& performance) {
  BodyPose pose = bind_pose(figure);
  for (std::size_t j = 0; j < figure.joints.size(); ++j) {
    pose.G[j] = Eigen::Quaternionf(performance.X_BJ[j].linear() * figure.joints[j].X_HJ.linear().transpose());
    pose.G[j].normalize();
    pose.p_S[j] = performance.X_BJ[j].translation();
    const int parent = figure.joints[j].parent;
    pose.turn[j] = parent < 0 ? pose.G[j] : (pose.G[at(parent)].conjugate() * pose.G[j]).normalized();
  }
  pose.root_p_S = pose.p_S[0];
  return pose;
}

PoseJudge::PoseJudge(const Figure& figure) : figure_(figure), anatomy_(anatomy_of(figure).value()) {}

void PoseJudge::look(const Performance& performance, const std::string& when, bool jumped) {
  for (const Eigen::Isometry3f& X : performance.X_BJ) finite = finite && X.matrix().allFinite();
  const BodyPose now = shown_pose(figure_, performance);
  for (const JointAngle& angle : joint_angles(figure_, anatomy_, now)) {
    const float beyond = angle.excess_rad() * degrees_per_radian;
    const bool out = beyond > 1;
    if (!out && breaks.count(angle.name) == 0) continue;
    Break& broken = breaks[angle.name];
    if (out && !std::exchange(broken.out, out) && broken.times++ == 0) broken.first = when;
    broken.out = out;
    broken.frames += out ? 1 : 0;
    if (out && beyond > broken.worst.value) broken.worst = {beyond, angle.name, when};
  }
  if (!before_.turn.empty() && !jumped) {
    for (std::size_t j = 0; j < now.turn.size(); ++j) {
      const std::string& name = figure_.joints[j].name;
      // Eyes jump: a saccade takes a frame.
      if (name.find("eyeball") == std::string::npos) {
        const float turn = before_.turn[j].angularDistance(now.turn[j]) * degrees_per_radian;
        if (turn > turn_deg.value) turn_deg = {turn, name, when};
      }
      const float move = (before_.p_S[j] - now.p_S[j]).norm();
      if (move > move_m.value) move_m = {move, name, when};
    }
  }
  before_ = now;
}

Moves fifty_moves() {
  Moves moves;
  int from = 1;
  for (int i = 1; i <= 50; ++i) {
    const int to = 1 + i * 17 % 50;
    moves.emplace_back(from, to);
    from = to;
  }
  return moves;
}

Moves all_moves() {
  Moves moves;
  for (int a = 1; a <= 50; ++a) {
    for (int b = a + 1; b <= 50; ++b) {
      moves.emplace_back(a, b);
      moves.emplace_back(b, a);
    }
  }
  return moves;
}

GraspFigures measure_grasps(const Figure& figure, Hand hand, const Moves& moves, bool skin) {
  GraspFigures worst;
  Rehearsal r(figure);
  Scene scene = board_with({{"light_1", moves.front().first}});
  r.frame({}, &scene);
  r.take_seat("instant");
  const std::string side = side_of(hand);
  const Figure whole_hand = flesh_of(figure, hand_joints(side));
  const std::array<Figure, 3> fingers{flesh_of(figure, {side + "thumb"}), flesh_of(figure, {side + "index"}),
                                      flesh_of(figure, {side + "middle"})};
  int stands = moves.front().first;
  std::uint64_t id = 0;
  for (const auto& [from, to] : moves) {
    ++id;
    const Scene* fresh = nullptr;
    if (stands != from) {
      scene = board_with({{"light_1", from}});
      fresh = &scene;
    }
    const Point3 goal = centre_of_square_B(to, scene.board);
    r.frame({grasp(id, "light_1", {goal}, hand)}, fresh);
    for (int i = 0; i < 300 && !r.ended(id); ++i) {
      r.frame();
      if (skin && phase(r, id) == "carry") look_at_carried(r, scene.board, whole_hand, fingers, worst);
    }
    ++worst.grasps;
    const bool done = r.said[id].back().state == FeedbackState::finished;
    if (!done) ++worst.failed;
    stands = done ? to : 0;
    for (const Feedback& f : r.said[id]) {
      if (static_cast<float>(f.gap_mm) > worst.worst_gap_mm)
        worst.where = std::to_string(from) + "-" + std::to_string(to);
      worst.worst_gap_mm = std::max(worst.worst_gap_mm, static_cast<float>(f.gap_mm));
    }
    if (!done) continue;
    const Vector3f put(static_cast<float>(goal[0]), static_cast<float>(goal[1]), static_cast<float>(goal[2]));
    worst.worst_place_mm = std::max(worst.worst_place_mm, 1000 * (r.piece("light_1") - put).norm());
  }
  return worst;
}

ClearanceFigures measure_clearance(const Figure& figure, int moves, unsigned seed) {
  ClearanceFigures worst;
  Rehearsal r(figure);
  std::map<int, std::string> at_square;
  const Scene scene = crowded_board(at_square);
  r.frame({}, &scene);
  r.take_seat("instant");
  std::vector<std::string> joints{"l_forearm", "r_forearm", "l_elbow", "r_elbow"};
  for (const char* side : {"l_", "r_"}) {
    for (const std::string& name : hand_joints(side)) joints.push_back(name);
  }
  const Figure arms = flesh_of(figure, joints);
  std::mt19937 random(seed);
  const auto height = static_cast<float>(scene.board.piece_height_m);
  const Home home = home_of(scene, anatomy_of(figure).value());
  const float table_edge = home.table_edge_y;
  const float half_board =
      static_cast<float>(scene.board.squares * scene.board.square_size_m / 2 + scene.board.border_m);
  for (int move = 1; move <= moves; ++move) {
    const auto id = static_cast<std::uint64_t>(move);
    auto from = at_square.begin();
    std::advance(from, static_cast<long>(random() % at_square.size()));
    int to = 0;
    while (to < 21 || at_square.count(to) != 0) to = 21 + static_cast<int>(random() % 30);
    const std::string piece = from->second;
    const std::string what = std::to_string(from->first) + "-" + std::to_string(to);
    at_square.erase(from);
    at_square[to] = piece;
    r.frame({grasp(id, piece, {centre_of_square_B(to, scene.board)})});
    for (int i = 0; i < 300 && !r.ended(id); ++i) {
      r.frame();
      const std::vector<Vector3f> feet = feet_but(r, scene, piece);
      for (const Vector3f& p : skin_places(arms, r)) {
        const bool over_board = std::abs(p.x()) < half_board && std::abs(p.y()) < half_board;
        const float floor = over_board ? 0.F : static_cast<float>(-scene.board.thickness_m);
        // Under the top, or in through the table's edge, whichever way out is shorter.
        const float below = std::min(floor - p.z(), p.y() - table_edge);
        if (1000 * below > worst.in_table_mm) {
          worst.in_table_mm = 1000 * below;
          worst.where_in_table = what + " " + phase(r, id) + " at " + std::to_string(p.x()) + " " +
                                 std::to_string(p.y()) + " " + std::to_string(p.z());
        }
        if (p.z() > 2 * height) continue;
        for (const Vector3f& foot : feet) {
          if (std::abs(p.x() - foot.x()) > 0.02F) continue;
          const float deep = -1000 * distance_to_piece(p, foot, scene.board);
          float& so_far = worst.in_pieces_by_phase_mm[phase(r, id)];
          so_far = std::max(so_far, deep);
          if (deep > worst.in_pieces_mm) {
            worst.in_pieces_mm = deep;
            worst.where =
                what + " " + phase(r, id) + " at " + std::to_string(foot.x()) + " " + std::to_string(foot.y());
          }
        }
      }
    }
    ++worst.moves;
    if (r.said[id].back().state != FeedbackState::finished) ++worst.failed;
    for (const Feedback& f : r.said[id]) worst.gap_mm = std::max(worst.gap_mm, static_cast<float>(f.gap_mm));
  }
  return worst;
}

SlideFigures measure_walk(const Figure& figure) {
  SlideFigures worst;
  Rehearsal r(figure);
  const Scene scene = board_with({});
  r.frame({}, &scene);
  const auto floor = static_cast<float>(-scene.table_height_m);
  const std::array<Figure, 2> feet{flesh_of(figure, names_from(figure, "l_ankle")),
                                   flesh_of(figure, names_from(figure, "r_ankle"))};
  std::array<std::vector<Vector3f>, 2> before;
  std::array<std::vector<float>, 2> travelled;
  constexpr float bears_m = 0.0015F;  // skin that is so near the floor counts as standing on it
  const auto look = [&](bool walks) {
    float lowest = 1;
    for (std::size_t s = 0; s < 2; ++s) {
      const std::vector<Vector3f> now = skin_places(feet[s], r);
      travelled[s].resize(now.size(), 0);
      bool bears = false;
      bool bore = false;
      for (std::size_t v = 0; v < now.size(); ++v) {
        const bool stays = !before[s].empty() && now[v].z() < floor + bears_m && before[s][v].z() < floor + bears_m;
        travelled[s][v] = stays ? travelled[s][v] + 1000 * (now[v] - before[s][v]).head<2>().norm() : 0;
        bears = bears || now[v].z() < floor + bears_m;
        bore = bore || (!before[s].empty() && before[s][v].z() < floor + bears_m);
        worst.worst_mm = std::max(worst.worst_mm, travelled[s][v]);
        worst.sunk_mm = std::max(worst.sunk_mm, 1000 * (floor - now[v].z()));
        lowest = std::min(lowest, now[v].z() - floor);
      }
      if (bears && !bore) ++worst.steps;
      before[s] = now;
    }
    if (walks) worst.lifted_mm = std::max(worst.lifted_mm, 1000 * lowest);
  };
  std::uint64_t id = 0;
  for (const Command& command :
       {navigate(1, "seat"), navigate(2, "chair"), navigate(3, "", {{1.2, -1.2, 0}, {1.4, -0.2, 0}, {0.9, 0.9, 0}}),
        navigate(4, "seat", {}, "hurry"), navigate(5, "away")}) {
    id = command.id;
    r.frame({command});
    for (int i = 0; i < 1000 && !r.ended(id); ++i) {
      r.frame();
      look(phase(r, id) == "walk");
    }
  }
  return worst;
}

Command random_command(std::uint64_t id, std::mt19937& random) {
  const auto any_place = [&] { return centre_of_square_B(1 + static_cast<int>(random() % 50), BoardGeometry{}); };
  Command c;
  c.id = id;
  c.interrupt = random() % 5 == 0;
  if (random() % 6 == 0 && id > 3) c.after = {id - 1 - random() % 3};
  if (random() % 8 == 0) c.delay_ms = static_cast<std::int64_t>(random() % 700);
  if (random() % 6 == 0) c.deadline_ms = 200 + static_cast<std::int64_t>(random() % 3000);
  const Hand hand = static_cast<Hand>(1 + random() % 3);
  switch (random() % 9) {
    case 0:
    case 1:
      c.action = Grasp{"light_" + std::to_string(31 + random() % 21), {any_place()}, hand, "", 0};
      break;
    case 2:
      c.action = Grasp{"", {any_place()}, hand, random() % 2 == 0 ? "point" : "", 0};
      break;
    case 3:
    case 4: {
      auto clip = clip_library().begin();
      std::advance(clip, static_cast<long>(random() % clip_library().size()));
      c.action =
          Keyframe{clip->first, 0.5 + 0.1 * static_cast<double>(random() % 20), 1, BodyPart::whole, random() % 10 == 0};
      break;
    }
    case 5: {
      const std::vector<std::string> places{"seat", "seat", "seat", "entrance", "chair", "away", "moon"};
      c.action = Navigate{places[random() % places.size()], {}, 0, "hurry"};
      break;
    }
    case 6:
      c.action = Gaze{static_cast<GazeTarget>(1 + random() % 6), 1 + static_cast<int>(random() % 50), "light_31",
                      any_place(), 0};
      break;
    case 7:
      c.action = Say{"It is your move.", "en", ""};
      break;
    default:
      if (random() % 3 == 0) {
        c.action = Stop{{id - 1 - random() % 4}};
      } else {
        c.action = Express{"smile", 1, 0.5};
      }
      break;
  }
  return c;
}

ChaosFigures measure_chaos(const Figure& figure, int commands, unsigned seed, PoseJudge& judge) {
  ChaosFigures result;
  Rehearsal r(figure);
  std::vector<std::pair<std::string, int>> men;
  for (int square = 31; square <= 50; ++square) men.emplace_back("light_" + std::to_string(square), square);
  const Scene scene = board_with(men);
  r.frame({}, &scene);
  r.take_seat("instant");
  std::mt19937 random(seed);
  const auto step = [&](const std::vector<Command>& now, const std::string& when) {
    r.frame(now);
    judge.look(r.last, when);
  };
  for (int i = 1; i <= commands; ++i) {
    const auto id = static_cast<std::uint64_t>(i);
    std::vector<Command> now{random_command(id, random)};
    if (i % 50 == 0) {
      now.push_back({});
      now.back().id = 2'000'000 + id;
      now.back().action = Stop{};
    }
    step(now, "command " + std::to_string(i));
    // Now and then there is time to get on with it.
    const unsigned pause = random() % 8 == 0 ? random() % 40 : 0;
    for (unsigned k = 0; k < pause; ++k) step({}, "after command " + std::to_string(i));
  }
  Command stop;
  stop.id = 3'000'000;
  stop.action = Stop{};
  step({stop}, "the stop");
  for (int i = 0; i < 500; ++i) step({}, "after the stop");
  result.commands = commands;
  for (int i = 1; i <= commands; ++i) {
    const std::vector<Feedback>& said = r.said[static_cast<std::uint64_t>(i)];
    int finals = 0;
    for (const Feedback& f : said) {
      if (!is_final(f.state)) continue;
      ++finals;
      ++result.ends[f.state];
    }
    if (finals == 0) ++result.without_answer;
    if (finals > 1) ++result.with_several;
    if (finals > 0 && !is_final(said.back().state)) ++result.said_after_end;
  }
  PoseJudge end(figure);
  end.look(r.last, "the end");
  result.legal_end = end.finite && end.breaks.empty();
  return result;
}

void play_every_clip(const Figure& figure, PoseJudge& judge) {
  for (const char* place : {"seat", "chair"}) {
    Rehearsal r(figure);
    const Scene scene = board_with({});
    r.frame({}, &scene);
    r.frame({navigate(1'000'000, place, {}, "instant")});
    bool jumped = true;
    std::uint64_t id = 0;
    for (const auto& [name, clip] : clip_library()) {
      for (const double speed : {1.0, 1.0, 1.0, 1.6}) {  // thrice: those that vary show each of their ways
        Command c;
        c.id = ++id;
        c.action = Keyframe{name, speed, 1, BodyPart::whole, false};
        r.frame({c});
        judge.look(r.last, name, std::exchange(jumped, false));
        for (int i = 0; i < 400 && !r.ended(id); ++i) {
          r.frame();
          judge.look(r.last, name);
        }
        for (int i = 0; i < 25; ++i) {
          r.frame();
          judge.look(r.last, "after " + name);
        }
      }
    }
  }
}

void expect_within_bounds(const PoseJudge& judge) {
  for (const auto& [name, broken] : judge.breaks) {
    ADD_FAILURE() << name << " left its range " << broken.times << " times, first " << broken.first << "; at most by "
                  << broken.worst.value << " degrees, " << broken.worst.when;
  }
  EXPECT_LT(judge.turn_deg.value, largest_turn_deg()) << judge.turn_deg.joint << ", " << judge.turn_deg.when;
  EXPECT_LT(judge.move_m.value, largest_move_m()) << judge.move_m.joint << ", " << judge.move_m.when;
}

}  // namespace counterpart
