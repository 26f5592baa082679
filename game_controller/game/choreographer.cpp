#include "game_controller/game/choreographer.hpp"

#include <algorithm>
#include <utility>

namespace counterpart {
namespace {

constexpr std::size_t most_outstanding = 64;
constexpr std::int64_t grasp_deadline_ms = 20'000;

Gaze at_square(int square) {
  Gaze gaze;
  gaze.target = GazeTarget::square;
  gaze.square = square;
  return gaze;
}

Gaze at_player() {
  Gaze gaze;
  gaze.target = GazeTarget::player;
  return gaze;
}

Keyframe clip(const char* name) {
  Keyframe keyframe;
  keyframe.clip = name;
  return keyframe;
}

Say words(const std::string& code, const std::string& text) {
  Say say;
  say.text = text;
  say.code = code;
  return say;
}

Express face(const char* name, double weight, double hold_s) {
  Express express;
  express.face = name;
  express.weight = weight;
  express.hold_s = hold_s;
  return express;
}

}  // namespace

std::uint64_t Choreographer::tell(Action action, std::vector<std::uint64_t> after, std::int64_t deadline_ms) {
  Command command;
  command.id = next_id_++;
  command.action = std::move(action);
  command.after = std::move(after);
  command.deadline_ms = deadline_ms;
  told_.push_back(command);
  outstanding_.push_back(std::move(command));
  if (outstanding_.size() > most_outstanding) outstanding_.erase(outstanding_.begin());
  return told_.back().id;
}

std::vector<Command> Choreographer::take() {
  return std::exchange(told_, {});
}

void Choreographer::hear(const Feedback& feedback) {
  if (!is_final(feedback.state)) return;
  std::erase_if(outstanding_, [&](const Command& c) { return c.id == feedback.command_id; });
}

void Choreographer::enter() {
  std::vector<Command> again = std::exchange(outstanding_, {});
  told_.clear();
  renamed_.clear();
  Navigate seat;
  seat.place = "seat";
  const std::uint64_t seated = tell(seat);
  tell(at_square(board_.squares * board_.squares / 4), {seated});
  for (Command& command : again) {
    if (std::holds_alternative<Navigate>(command.action)) continue;
    std::vector<std::uint64_t> after{seated};
    for (const std::uint64_t old : command.after) {
      for (const auto& [from, to] : renamed_) {
        if (from == old) after.push_back(to);
      }
    }
    const std::uint64_t old = command.id;
    const std::uint64_t fresh = tell(std::move(command.action), std::move(after), command.deadline_ms);
    renamed_.emplace_back(old, fresh);
  }
}

std::uint64_t Choreographer::current_id(std::uint64_t told_id) const {
  for (const auto& [from, to] : renamed_) {
    if (from == told_id) return to;
  }
  return told_id;
}

void Choreographer::watch_board() {
  tell(at_square(board_.squares * board_.squares / 4));
}

void Choreographer::watch_player() {
  tell(at_player());
}

void Choreographer::think() {
  watch_board();
  tell(clip("think"));
}

void Choreographer::say(const std::string& code, const std::string& text) {
  tell(words(code, text));
}

std::uint64_t Choreographer::move(const std::string& piece, const std::vector<int>& route, bool second_try) {
  const std::uint64_t look = tell(at_square(route.front()));
  Grasp grasp;
  grasp.piece = piece;
  for (std::size_t i = 1; i < route.size(); ++i) grasp.path_B.push_back(centre_of_square_B(route[i], board_));
  if (second_try) {
    grasp.hand = Hand::left;
    grasp.style = "hesitant";
  }
  const std::uint64_t carried = tell(grasp, {look}, grasp_deadline_ms);
  tell(at_player(), {carried});
  return carried;
}

std::uint64_t Choreographer::carry(const std::string& piece, const Point3& to_B) {
  // One after the other: two hands at once over the same squares would be in each other's way.
  std::vector<std::uint64_t> after;
  std::int64_t patience_ms = grasp_deadline_ms;
  for (const Command& command : outstanding_) {
    if (!std::holds_alternative<Grasp>(command.action)) continue;
    after = {command.id};
    patience_ms += grasp_deadline_ms / 4;
  }
  Grasp grasp;
  grasp.piece = piece;
  grasp.path_B = {to_B};
  return tell(grasp, std::move(after), patience_ms);
}

std::uint64_t Choreographer::ask_to_move(const std::vector<int>& route, const std::string& text) {
  const std::uint64_t look = tell(at_square(route.front()));
  Grasp pointing;  // no piece
  for (const int square : route) {
    Point3 above = centre_of_square_B(square, board_);
    above[2] = 3 * board_.piece_height_m;
    pointing.path_B.push_back(above);
  }
  const std::uint64_t shown = tell(pointing, {look}, grasp_deadline_ms);
  tell(words("make_it_for_me", text), {look});
  tell(at_player(), {shown});
  return shown;
}

void Choreographer::object(const std::string& code, const std::string& text, int square) {
  if (square > 0) tell(at_square(square));
  tell(face("doubt", 0.8, 2.5));
  const std::uint64_t shaken = tell(clip("head_shake"));
  tell(words(code, text));
  tell(at_player(), {shaken});
}

void Choreographer::point_at(int square, const std::string& code, const std::string& text) {
  const std::uint64_t look = tell(at_square(square));
  Grasp touch;  // no piece: only reaches towards the square
  Point3 above = centre_of_square_B(square, board_);
  above[2] = 3 * board_.piece_height_m;
  touch.path_B.push_back(above);
  tell(touch, {look}, grasp_deadline_ms);
  tell(words(code, text), {look});
}

void Choreographer::conclude(bool won, bool drawn, const std::string& code, const std::string& text) {
  tell(at_player());
  tell(face(won || drawn ? "smile" : "sad", 0.8, 6));
  tell(clip(won || drawn ? "offer_hand" : "applaud"));
  tell(words(code, text));
}

void Choreographer::stop() {
  outstanding_.clear();
  tell(Stop{});
}

}  // namespace counterpart
