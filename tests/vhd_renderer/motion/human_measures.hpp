// What can be measured of a performance from outside: joints, drawn skin and pieces as they are shown, nothing that the
// director believes of itself. Shared by the tests (short) and tests/bench/measure_human (in full).
#pragma once

#include <array>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/vhd_renderer/motion/rehearsal.hpp"
#include "vhd_renderer/motion/joint_angles.hpp"
#include "vhd_renderer/motion/stance.hpp"

namespace counterpart {

// The largest jumps of a joint from frame to frame at 25 a second.
inline float largest_turn_deg() {
  return joint_limit::fastest_turn_rad_s / 25 * 57.29578F;
}
inline float largest_move_m() {
  return joint_limit::fastest_move_m_s / 25;
}

// Signed distance of a point from a piece that lies flat on its foot, metres; negative inside.
float distance_to_piece(const Eigen::Vector3f& p, const Eigen::Vector3f& foot, const BoardGeometry& board);

// The figure with those vertices only that go at least half with joints whose names start with one of these.
Figure flesh_of(const Figure& figure, const std::vector<std::string>& joint_starts);

// The same figure larger or smaller.
Figure scaled(Figure figure, float scale);

// Where its skin is shown, in B; by part of the flesh.
std::vector<Eigen::Vector3f> skin_places(const Figure& flesh, const Rehearsal& rehearsal);

// The pose that is shown, of a human on the light side.
BodyPose shown_pose(const Figure& figure, const Performance& performance);

// Watches every frame: angles beyond their range, and how far joints get from one frame to the next.
class PoseJudge {
 public:
  explicit PoseJudge(const Figure& figure);

  struct Worst {
    float value = 0;
    std::string joint;
    std::string when;
  };

  // `jumped`: he is somewhere else at once because he was told to be; then the change counts as none.
  void look(const Performance& performance, const std::string& when, bool jumped = false);

  // An angle that left its range by more than a degree.
  struct Break {
    Worst worst;
    int times = 0;      // that it left its range
    int frames = 0;     // that it was out
    std::string first;  // when it first did
    bool out = false;   // now
  };

  std::map<std::string, Break> breaks;  // by angle
  Worst turn_deg;                       // of a joint against its parent, in a frame
  Worst move_m;                         // of a joint in the room, in a frame
  bool finite = true;

 private:
  const Figure& figure_;
  Anatomy anatomy_;
  BodyPose before_;
};

// Fails the test that runs for every angle that left its range, a joint that jumped, and a pose that is none.
void expect_within_bounds(const PoseJudge& judge);

using Moves = std::vector<std::pair<int, int>>;  // squares

// Every square once as origin and once as target; near and far in turn.
Moves fifty_moves();
// Every square to every other: 2450 moves.
Moves all_moves();

struct GraspFigures {
  int grasps = 0;
  int failed = 0;
  float worst_gap_mm = 0;                // of the grasp point from the piece when the hand closes and when it opens
  std::string where;                     // in which move
  float worst_place_mm = 0;              // of the piece from where it was to be put, of those that are done
  float deepest_mm = 0;                  // skin of the hand in the piece it carries
  std::array<float, 3> widest_gap_mm{};  // between the piece and the skin of thumb, forefinger, middle finger
  float below_board_mm = 0;              // skin of the hand under the board's surface while it carries
};

// Seated, one piece, one move after the other. `skin`: the carrying is measured on the drawn skin, too.
GraspFigures measure_grasps(const Figure& figure, Hand hand, const Moves& moves, bool skin);

struct ClearanceFigures {
  int moves = 0;
  int failed = 0;
  float in_pieces_mm = 0;  // skin of hands and forearms inside any piece but the one that is moved
  float in_table_mm = 0;   // and under board and table
  float gap_mm = 0;        // of the grasp point from the piece, at its worst
  std::string where;       // of the worst
  std::map<std::string, float> in_pieces_by_phase_mm;
  std::string where_in_table;
};

// Random moves of light men between dark pieces, some of them kings.
ClearanceFigures measure_clearance(const Figure& figure, int moves, unsigned seed);

struct SlideFigures {
  int steps = 0;
  float worst_mm = 0;   // a sole's travel while it bears on the floor, by step
  float lifted_mm = 0;  // the lower sole over the floor at its worst while he walks
  float sunk_mm = 0;    // skin of the feet under the floor
};

// Comes in, sits down, gets up, walks a path with corners and goes.
SlideFigures measure_walk(const Figure& figure);

// A command at random out of everything a director may be told, some of it nonsense.
Command random_command(std::uint64_t id, std::mt19937& random);

struct ChaosFigures {
  int commands = 0;
  int without_answer = 0;
  int with_several = 0;
  int said_after_end = 0;
  std::map<FeedbackState, int> ends;
  bool legal_end = false;  // every angle in its range when it is over
};

// Random commands, cancelled and interrupted at random, one a frame; `judge` sees every frame.
ChaosFigures measure_chaos(const Figure& figure, int commands, unsigned seed, PoseJudge& judge);

// Plays every clip of the library, seated and standing, with and without a turned weight.
void play_every_clip(const Figure& figure, PoseJudge& judge);

}  // namespace counterpart
