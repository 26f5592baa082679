#include "tests/bench/game_suite/play.hpp"

#include <algorithm>
#include <ctime>
#include <optional>
#include <ostream>
#include <random>
#include <utility>

#include "game_controller/game/game.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/pose_eigen.hpp"
#include "stage/film/film.hpp"
#include "stage/record/record.hpp"
#include "tracker_server/pipeline/observe.hpp"
#include "tracker_server/pipeline/real_pieces.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart::bench {
namespace {

constexpr std::int64_t kHandWorks_ns = 200'000'000;  // how long the virtual human takes for whatever he is told
constexpr double kLightEnough = 0.2;                 // of a bright day: darker, nobody could see the pieces
constexpr double kEdgesSeen = 0.6;                   // hidden share of the board's lines: beyond it the board is gone

// The virtual player's mind: any legal move.
std::optional<std::string> any_move(const std::string& rules_name, const std::string& fen, std::mt19937_64& random) {
  const Rules* rules = find_rules(rules_name);
  const auto position = read_fen(*rules, fen);
  if (!position) return std::nullopt;
  MoveList moves;
  generate(*rules, *position, moves);
  if (moves.empty()) return std::nullopt;
  const auto chosen = static_cast<int>(random() % static_cast<std::uint64_t>(moves.size()));
  return path_text(*rules, *position, moves[chosen]);
}

bool is_right_code(stage::IllegalKind kind, const std::string& code) {
  switch (kind) {
    case stage::IllegalKind::backwards:
      return code == "moved_backwards";
    case stage::IllegalKind::sideways:
      return code == "not_diagonal";
    case stage::IllegalKind::too_far:
      return code == "moved_too_far" || code == "jumped_own_piece";
    case stage::IllegalKind::two_pieces:
      return code == "two_pieces_moved";
    case stage::IllegalKind::wrong_piece:
      return code == "must_capture";
  }
  return false;
}

std::string text_of(const stage::PlayerMove& move) {
  std::string text;
  for (const int square : move.path)
    text += (text.empty() ? "" : move.captured.empty() ? "-" : "x") + std::to_string(square);
  return text;
}

bool same_move(const stage::PlayerMove& made, const std::vector<int>& path, std::vector<int> captured) {
  std::vector<int> really = made.captured;
  std::sort(really.begin(), really.end());
  std::sort(captured.begin(), captured.end());
  return !path.empty() && made.path.front() == path.front() && made.path.back() == path.back() && really == captured;
}

std::ostream& operator<<(std::ostream& out, const std::vector<int>& squares) {
  for (const int square : squares) out << ' ' << square;
  return out;
}

// 'b' for every real piece: kings are crowned some time after their move.
std::string men(std::string squares) {
  std::replace(squares.begin(), squares.end(), 'B', 'b');
  return squares;
}

// How far the board's corners are from where they should be in the picture, the farthest of four.
double corners_off_px(const stage::Truth& truth, const Observation& observation) {
  const double half = 0.5 * truth.board.squares * truth.board.square_size_m;
  const Eigen::Isometry3d seen_X_CB = to_eigen(observation.pose.X_CB);
  double off = 0;
  for (const double x : {-half, half})
    for (const double y : {-half, half})
      off = std::max(
          off, (project(truth.view, {x, y, 0}) - project(observation.intrinsics, seen_X_CB * Eigen::Vector3d(x, y, 0)))
                   .norm());
  return off;
}

class Match {
 public:
  Match(const stage::Scenario& scenario, const PlayOptions& options, stage::Film film, Game game, std::string rules)
      : options_(options),
        film_(std::move(film)),
        game_(std::move(game)),
        rules_(std::move(rules)),
        context_(observe_options(scenario, options)),
        random_(scenario.seed) {
    played_.name = scenario.name;
  }

  Played run();

 private:
  static ObserveOptions observe_options(const stage::Scenario& scenario, const PlayOptions& options) {
    ObserveOptions observe;
    observe.board = scenario.board;
    observe.intrinsics = scenario.intrinsics;
    observe.method = options.method;
    observe.lockstep = true;
    return observe;
  }

  bool finished() const;
  void step();
  void obey(const GameOutputs& outputs);
  void watch(const stage::Truth& truth);
  void log_event(const GameEvent& event);
  void log_sight(const stage::Truth& truth, const Observation& observation);
  void check_commit(const GameEvent& event, const stage::Truth& truth);
  void check_objection(const GameEvent& event, const stage::Truth& truth);
  void answer_question(const GameEvent& event);
  void compare();

  PlayOptions options_;
  stage::Film film_;
  Game game_;
  std::string rules_;
  ObserveContext context_;
  std::mt19937_64 random_;
  Played played_;
  std::vector<stage::BoardMoment> moments_;
  std::vector<std::pair<std::int64_t, std::uint64_t>> told_;  // when done, which command
  std::string sight_;                                         // as logged last
  std::vector<Control> controls_;
  std::optional<std::string> answer_;
  std::int64_t now_ns_ = 0, last_move_ns_ = 0, clear_since_ns_ = 0;
  bool clear_ = false;
  bool asked_ = false;  // about the move in question
  bool arm_over_board_ = false;
  std::size_t objections_seen_ = 0;  // of the player's illegal moves: those that were objected to
};

bool Match::finished() const {
  const BoardState& state = game_.board_state();
  if (state.phase == GamePhase::over) return true;
  return static_cast<int>(state.moves.size()) >= options_.plies && state.phase == GamePhase::real_to_move;
}

Played Match::run() {
  const std::clock_t start = std::clock();
  while (!finished() && !options_.stop()) {
    step();
    if (static_cast<double>(now_ns_ - last_move_ns_) > options_.patience_s * 1e9) {
      played_.trouble = "no move for " + std::to_string(static_cast<int>(options_.patience_s)) + " s in phase " +
                        std::to_string(static_cast<int>(game_.board_state().phase));
      break;
    }
  }
  compare();
  played_.plies = static_cast<int>(game_.board_state().moves.size());
  played_.cpu_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return std::move(played_);
}

void Match::step() {
  // While the arm is over the board nothing can be read: of those frames every other one is dropped, as a slow computer
  // would. Its leaving is filmed at the full rate.
  if (arm_over_board_ && played_.frames % 2 == 0) film_.skip();
  const stage::Shot shot = film_.next();
  arm_over_board_ = shot.truth.hand_share > 0.02;
  now_ns_ = shot.truth.stamp.capture_ns;
  ++played_.frames;
  watch(shot.truth);

  context_.expect(real_pieces(game_.board_state()));
  const Observation observation = observe({shot.truth.stamp, shot.image_bgr}, context_);
  double ms = 0;
  for (const auto& [step, step_ms] : observation.step_ms) ms += step_ms;
  played_.observe_ms.push_back(static_cast<float>(ms));
  if (observation.occupancy)
    played_.reading_ms.push_back(static_cast<float>(observation.step_ms.at("view") + observation.step_ms.at("pieces")));

  GameInputs inputs;
  inputs.now_ns = now_ns_;
  inputs.sight = observation.occupancy;
  inputs.engine_move = std::exchange(answer_, std::nullopt);
  inputs.controls = std::exchange(controls_, {});
  std::erase_if(told_, [&](const auto& told) {
    if (told.first > now_ns_) return false;
    Feedback feedback;
    feedback.command_id = told.second;
    feedback.state = FeedbackState::finished;
    feedback.stamp_ns = now_ns_;
    inputs.feedback.push_back(feedback);
    return true;
  });
  const GameOutputs outputs = game_.step(inputs);
  if (options_.log != nullptr) log_sight(shot.truth, observation);
  for (const GameEvent& event : outputs.events) {
    log_event(event);
    if (event.kind == EventKind::move) last_move_ns_ = now_ns_;
    if (event.kind == EventKind::move && event.side == Side::dark) check_commit(event, shot.truth);
    if (event.kind == EventKind::illegal_move) check_objection(event, shot.truth);
    if (event.kind == EventKind::board_unclear && event.code == "which_capture") answer_question(event);
  }
  obey(outputs);
}

void Match::obey(const GameOutputs& outputs) {
  for (const Command& command : outputs.commands) told_.emplace_back(now_ns_ + kHandWorks_ns, command.id);
  if (outputs.think) answer_ = any_move(rules_, *outputs.think, random_);
  if (outputs.board_state) film_.show(*outputs.board_state);
}

void Match::watch(const stage::Truth& truth) {
  moments_.push_back({truth.stamp.capture_ns, truth.occupancy, truth.holds_piece});
  const bool clear = truth.hand_share == 0 && truth.edges_hidden < kEdgesSeen && film_.world().light > kLightEnough;
  if (clear && !clear_) clear_since_ns_ = now_ns_;
  clear_ = clear;
}

void Match::log_event(const GameEvent& event) {
  if (options_.log == nullptr) return;
  *options_.log << 1e-9 * static_cast<double>(now_ns_) << " s: " << name_of(event.kind) << ' ' << event.move << ' '
                << event.code << ", squares" << event.squares << ", captured" << event.captured;
  if (event.kind == EventKind::move && event.side == Side::dark && clear_)
    *options_.log << "; " << 1e-9 * static_cast<double>(now_ns_ - clear_since_ns_) << " s after the hand";
  if (event.kind == EventKind::move && !film_.player().moves().empty())
    *options_.log << "; the player's last was " << text_of(film_.player().moves().back());
  *options_.log << '\n';
}

// What the system sees, whenever that changes: "-": as it is, otherwise the squares that differ.
void Match::log_sight(const stage::Truth& truth, const Observation& observation) {
  std::string sight;
  if (!observation.occupancy) {
    sight = "no pose";
  } else if (observation.occupancy->covered) {
    sight = "covered";
  } else {
    const int squares = observation.occupancy->squares;
    for (int square = 1; square <= playable_squares(squares); ++square) {
      const Cell cell = cell_of_square(square, squares);
      const CellReading reading =
          observation.occupancy->cells[static_cast<std::size_t>(cell.row * squares + cell.col)].reading;
      const char there = truth.occupancy[static_cast<std::size_t>(square - 1)];
      if (reading == CellReading::unknown)
        sight += " " + std::to_string(square) + " unknown";
      else if ((reading != CellReading::empty) != (there != 'e'))
        sight += " " + std::to_string(square) + (there == 'e' ? " is empty" : " is taken");
    }
    if (sight.empty()) sight = "-";
  }
  if (sight == sight_) return;
  sight_ = sight;
  *options_.log << 1e-9 * static_cast<double>(now_ns_) << " s, frame " << played_.frames << ": sees " << sight
                << "; hand " << truth.hand_share << ", lines hidden " << truth.edges_hidden << ", light "
                << film_.world().light << ", pose " << name_of(observation.pose.status) << ", corners "
                << corners_off_px(truth, observation) << " px off\n";
}

void Match::check_commit(const GameEvent& event, const stage::Truth& truth) {
  const auto& made = film_.player().moves();
  const BoardState& state = game_.board_state();
  std::string recorded = real_pieces(state);
  const bool as_meant = !made.empty() && same_move(made.back(), event.squares, event.captured);
  const bool as_stands = !truth.holds_piece && men(recorded) == men(truth.occupancy);
  if (!as_meant || !as_stands) {
    ++played_.wrong_commits;
    played_.trouble += "move " + std::to_string(state.moves.size()) + " taken for " + event.move +
                       (made.empty() ? "" : ", he made " + text_of(made.back())) + "; ";
  }
  if (!asked_) played_.recognised_s.push_back(clear_ ? 1e-9 * static_cast<double>(now_ns_ - clear_since_ns_) : 0);
  asked_ = false;
}

void Match::check_objection(const GameEvent& event, const stage::Truth& truth) {
  const auto& illegal = film_.player().illegal_moves();
  if (illegal.size() == objections_seen_) {
    // Saying again what is still wrong is no new objection; calling wrong what is as it should be is a false one.
    if (truth.holds_piece || men(truth.occupancy) != men(real_pieces(game_.board_state()))) return;
    ++played_.false_alarms;
    played_.trouble += "objected (" + event.code + ") without cause; ";
    return;
  }
  objections_seen_ = illegal.size();
  if (is_right_code(illegal.back(), event.code)) {
    ++played_.illegal_right;
  } else {
    played_.trouble +=
        "illegal move " + std::to_string(static_cast<int>(illegal.back())) + " called " + event.code + "; ";
  }
}

// As he would on the page.
void Match::answer_question(const GameEvent&) {
  if (film_.player().moves().empty()) return;
  Control control;
  control.kind = ControlKind::it_was;
  control.text = text_of(film_.player().moves().back());
  controls_.push_back(control);
  asked_ = true;
  ++played_.asked;
}

void Match::compare() {
  played_.illegal_made = static_cast<int>(film_.player().illegal_moves().size());
  const auto check = stage::compare_record(game_.pdn(), moments_);
  if (!check) {
    played_.trouble += check.error().message;
  } else if (!check->agrees()) {
    played_.trouble += check->trouble;
  }
  played_.equal = check && check->agrees() && played_.wrong_commits == 0 && finished();
}

}  // namespace

Result<Played> play_game(const stage::Scenario& scenario, const PlayOptions& options) {
  auto film = stage::Film::begin(scenario);
  if (!film) return tl::make_unexpected(film.error());
  GameOptions game_options;
  game_options.board = scenario.board;
  game_options.rules = scenario.board.squares == 8 ? "brazilian" : "international";
  auto game = Game::start(game_options);
  if (!game) return tl::make_unexpected(game.error());
  return Match(scenario, options, std::move(*film), std::move(*game), game_options.rules).run();
}

}  // namespace counterpart::bench
