#include "stage/player/player.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace counterpart::stage {
namespace {

constexpr double kReach_s = 0.35;
constexpr double kFar_s_m = 0.7;  // longer over longer ways
constexpr double kCarry_s = 0.5;
constexpr double kWithdraw_s = 0.5;
constexpr double kFingers_s = 0.08;   // closing or opening them
constexpr double kPatience_s = 10.0;  // then he believes the mirror more than his memory

bool is_real_man(char square, Side real_side) {
  return real_side == Side::dark ? square == 'b' || square == 'B' : square == 'w' || square == 'W';
}

std::vector<int> squares_of(const std::string& squares, Side real_side) {
  std::vector<int> result;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (is_real_man(squares[i], real_side)) result.push_back(static_cast<int>(i) + 1);
  }
  return result;
}

// How many moves of the game so far are the real player's.
std::size_t real_moves(const BoardState& state) {
  return (state.moves.size() + (state.turn == state.virtual_side ? 1 : 0)) / 2;
}

std::vector<int> occupied(const World& world) {
  std::vector<int> result;
  for (const RealPiece& piece : world.pieces) {
    if (piece.square > 0) result.push_back(piece.square);
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

Player::Player(const PlayerOptions& options) : options_(options), random_(options.seed) {}

double Player::random(double from, double to) {
  // By hand, so that every standard library gives the same numbers.
  const double unit = static_cast<double>(random_() >> 11) * 0x1p-53;
  return from + unit * (to - from);
}

void Player::step(double dt_s, World& world) {
  if (!world.player_present) return;
  time_s_ += dt_s;
  if (gestures_.idle()) {
    waited_s_ += dt_s;
    hand_after_ = world.hand.pinch_B;
    decide(world);
    if (!gestures_.idle()) waited_s_ = 0;
  }
  gestures_.step(dt_s * options_.speed, world);
}

bool Player::rest_hand(const World& world) {
  if (rests_made_ >= options_.rests.size() || options_.rests[rests_made_].at_s > time_s_) return false;
  const HandRest& rest = options_.rests[rests_made_++];
  Stroke stroke;
  stroke.to_B = {rest.place_m.x(), rest.place_m.y(), grip_height_m(world.board) + world.board.piece_height_m};
  stroke.duration_s = kReach_s + kFar_s_m * (stroke.to_B - hand_after_).norm();
  stroke.arc_m = 0.05;
  gestures_.add(stroke);
  hand_after_ = stroke.to_B;
  pause(world, rest.for_s * options_.speed);
  withdraw(world);
  return true;
}

void Player::decide(World& world) {
  if (rest_hand(world)) return;
  if (options_.practise) return practise(world);
  if (!mirror_) return;
  const BoardState& state = *mirror_;
  if (state.squares.size() != static_cast<std::size_t>(playable_squares(world.board.squares))) return;
  const Side real_side = other(state.virtual_side);
  const std::vector<int> wanted = squares_of(state.squares, real_side);
  const std::vector<int> standing = occupied(world);
  switch (state.phase) {
    case GamePhase::waiting_for_removal:
      for (const int square : state.to_remove) {
        const int piece = piece_on(world, square);
        if (piece < 0) continue;
        if (gestures_.idle() && taken_off_ > 0 && waited_s_ < options_.forgets_s) return;
        if (gestures_.idle()) pause(world, random(0.2, 0.5));
        take_off(world, piece);
        ++taken_off_;
        if (options_.forgets_s > 0) break;
      }
      if (!gestures_.idle()) withdraw(world);
      return;
    case GamePhase::illegal:
      if (standing == wanted) return;
      pause(world, random(0.8, 1.4));
      return make_board_show(wanted, world);
    case GamePhase::setting_up:
      if (standing == wanted || waited_s_ < 1) return;
      return make_board_show(wanted, world);
    case GamePhase::real_to_move:
      if (state.turn != real_side) return;
      if (standing == wanted) return play(state, world);
      // He has moved and waits for the answer. If none comes he was not understood: back, and again.
      if (waited_s_ > kPatience_s) make_board_show(wanted, world);
      return;
    case GamePhase::virtual_to_move:
    case GamePhase::paused:
    case GamePhase::over:
      return;
  }
}

void Player::play(const BoardState& state, World& world) {
  crown_kings(state, world);
  if (!gestures_.idle()) return;
  if (play_illegally(world)) return;
  const std::vector<PlayerMove> moves = legal_moves(state.rules, state.squares, state.turn);
  if (moves.empty()) return;
  const auto chosen = static_cast<std::size_t>(random(0, static_cast<double>(moves.size())));
  const PlayerMove& move = moves[std::min(chosen, moves.size() - 1)];
  const int piece = piece_on(world, move.path.front());
  if (piece < 0) return;
  taken_off_ = 0;
  pause(world, random(0.2, 0.7));
  if (knocks_made_ < options_.knocks_over.size() && options_.knocks_over[knocks_made_] <= moves_made_ + 1) {
    ++knocks_made_;
    knock_over(world, piece);
  }
  reach_for(world, piece);
  carry(world, piece, move.path);
  withdraw(world);
  ++moves_made_;
  moves_.push_back(move);
}

// On the way to one piece the hand brushes the next, which tumbles half a square to the side, where nothing ever
// stands; he puts it up again.
void Player::knock_over(const World& world, int beside) {
  int victim = -1;
  double nearest = 1e9;
  const Eigen::Vector3d& goal = world.pieces[static_cast<std::size_t>(beside)].p_B;
  for (std::size_t i = 0; i < world.pieces.size(); ++i) {
    if (world.pieces[i].square == 0 || world.pieces[i].king || static_cast<int>(i) == beside) continue;
    const double distance = (world.pieces[i].p_B - goal).norm();
    if (distance < nearest) {
      nearest = distance;
      victim = static_cast<int>(i);
    }
  }
  if (victim < 0) return;
  const RealPiece& piece = world.pieces[static_cast<std::size_t>(victim)];
  const Eigen::Vector3d grip(0, 0, grip_height_m(world.board));
  const double aside = (piece.p_B.x() > 0 ? -0.6 : 0.6) * world.board.square_size_m;

  Stroke stroke;
  stroke.to_B = piece.p_B + grip;
  stroke.duration_s = kReach_s + kFar_s_m * (stroke.to_B - hand_after_).norm();
  stroke.arc_m = 0.03;
  gestures_.add(stroke);
  stroke.end = StrokeEnd::knock;
  stroke.piece = victim;
  stroke.foot_B = piece.p_B + Eigen::Vector3d(aside, 0, 0);
  stroke.to_B += Eigen::Vector3d(0.3 * aside, 0, 0.01);
  stroke.duration_s = 0.22;
  stroke.arc_m = 0;
  gestures_.add(stroke);
  hand_after_ = stroke.to_B;
  pause(world, random(0.5, 0.9));
  stroke.end = StrokeEnd::take;
  stroke.to_B = stroke.foot_B + grip;
  stroke.duration_s = kReach_s;
  gestures_.add(stroke);
  hand_after_ = stroke.to_B;
  pause(world, kFingers_s);
  carry(world, victim, {piece.square, piece.square});
}

std::vector<std::pair<int, int>> Player::wrong_piece(const World& world) const {
  const std::vector<PlayerMove> legal = legal_moves(mirror_->rules, mirror_->squares, mirror_->turn);
  if (legal.empty() || legal.front().captured.empty()) return {};
  const int n = world.board.squares;
  for (std::size_t i = 0; i < world.pieces.size(); ++i) {
    if (world.pieces[i].square == 0 || world.pieces[i].king) continue;
    const Cell from = cell_of_square(world.pieces[i].square, n);
    for (const int side : {-1, 1}) {
      const auto to = square_of_cell({from.row + 1, from.col + side}, n);
      if (to && mirror_->squares[static_cast<std::size_t>(*to - 1)] == 'e') return {{static_cast<int>(i), *to}};
    }
  }
  return {};
}

bool Player::play_illegally(const World& world) {
  if (illegal_made_ >= options_.illegal_moves.size()) return false;
  const IllegalMove& planned = options_.illegal_moves[illegal_made_];
  if (planned.at_move > moves_made_ + 1) return false;
  const int n = world.board.squares;
  const bool two = planned.kind == IllegalKind::two_pieces;
  const int rows = planned.kind == IllegalKind::backwards ? -1 : planned.kind == IllegalKind::too_far ? 2 : two ? 1 : 0;
  const int cols = planned.kind == IllegalKind::backwards || two ? 1 : 2;
  std::vector<std::pair<int, int>> chosen;  // piece, square
  if (planned.kind == IllegalKind::wrong_piece) chosen = wrong_piece(world);
  const bool by_steps = planned.kind != IllegalKind::wrong_piece;
  for (std::size_t i = world.pieces.size();
       by_steps && i-- > 0 && chosen.size() < (two ? 2u : 1u);) {  // from the front row
    if (world.pieces[i].square == 0 || world.pieces[i].king) continue;
    const Cell from = cell_of_square(world.pieces[i].square, n);
    for (const int side : {-cols, cols}) {
      const auto to = square_of_cell({from.row + rows, from.col + side}, n);
      if (!to || piece_on(world, *to) >= 0 || (mirror_ && mirror_->squares[static_cast<std::size_t>(*to - 1)] != 'e')) {
        continue;
      }
      if (planned.kind == IllegalKind::too_far && mirror_) {
        // Over one of the other side it would be a capture.
        const auto over = square_of_cell({from.row + rows / 2, from.col + side / 2}, n);
        const char between = over ? mirror_->squares[static_cast<std::size_t>(*over - 1)] : 'e';
        if (between != 'e' && piece_on(world, *over) < 0) continue;
      }
      if (!chosen.empty() && chosen.back().second == *to) continue;
      chosen.emplace_back(static_cast<int>(i), *to);
      break;
    }
  }
  if (chosen.size() < (two ? 2u : 1u)) return false;  // not possible here: at the next move then
  ++illegal_made_;
  illegal_.push_back(planned.kind);
  pause(world, random(0.2, 0.5));
  for (const auto& [piece, square] : chosen) {
    reach_for(world, piece);
    carry(world, piece, {world.pieces[static_cast<std::size_t>(piece)].square, square});
  }
  withdraw(world);
  return true;
}

void Player::practise(World& world) {
  if (waited_s_ < random(0.3, 1.0)) return;
  const int n = world.board.squares;
  std::vector<std::pair<int, int>> choices;
  for (std::size_t i = 0; i < world.pieces.size(); ++i) {
    if (world.pieces[i].square == 0) continue;
    const Cell from = cell_of_square(world.pieces[i].square, n);
    for (const Cell step : {Cell{1, -1}, Cell{1, 1}, Cell{-1, 1}}) {
      const auto to = square_of_cell({from.row + step.row, from.col + step.col}, n);
      if (to && piece_on(world, *to) < 0) choices.emplace_back(static_cast<int>(i), *to);
    }
  }
  if (choices.empty()) return;
  const auto& [piece, square] = choices[static_cast<std::size_t>(random_() % choices.size())];
  reach_for(world, piece);
  carry(world, piece, {world.pieces[static_cast<std::size_t>(piece)].square, square});
  withdraw(world);
}

void Player::make_board_show(const std::vector<int>& wanted, const World& world) {
  if (mirror_) moves_.resize(std::min(moves_.size(), real_moves(*mirror_)));  // the rest is taken back
  const std::vector<int> standing = occupied(world);
  std::vector<int> missing, surplus;
  std::set_difference(wanted.begin(), wanted.end(), standing.begin(), standing.end(), std::back_inserter(missing));
  std::set_difference(standing.begin(), standing.end(), wanted.begin(), wanted.end(), std::back_inserter(surplus));
  std::set<int> used;
  for (const int square : missing) {
    int piece = -1;
    if (!surplus.empty()) {
      piece = piece_on(world, surplus.back());
      surplus.pop_back();
    } else {
      for (std::size_t i = 0; i < world.pieces.size() && piece < 0; ++i) {
        const bool beside = world.pieces[i].square == 0 && world.pieces[i].p_B.z() > -1;
        if (beside && used.insert(static_cast<int>(i)).second) piece = static_cast<int>(i);
      }
    }
    if (piece < 0) break;
    reach_for(world, piece);
    carry(world, piece, {world.pieces[static_cast<std::size_t>(piece)].square, square});
  }
  for (const int square : surplus) take_off(world, piece_on(world, square));
  if (!gestures_.idle()) withdraw(world);
}

void Player::crown_kings(const BoardState& state, const World& world) {
  const char king = state.virtual_side == Side::light ? 'B' : 'W';
  for (std::size_t i = 0; i < state.squares.size(); ++i) {
    const int piece = state.squares[i] == king ? piece_on(world, static_cast<int>(i) + 1) : -1;
    if (piece < 0 || world.pieces[static_cast<std::size_t>(piece)].king) continue;
    const auto spare = std::find_if(world.pieces.begin(), world.pieces.end(),
                                    [](const RealPiece& p) { return p.square == 0 && p.p_B.z() > -1; });
    if (spare == world.pieces.end()) return;  // nothing left to crown with; the game knows that it is a king
    const RealPiece& crowned = world.pieces[static_cast<std::size_t>(piece)];
    reach_for(world, static_cast<int>(spare - world.pieces.begin()));
    Stroke stroke;
    stroke.to_B = crowned.p_B + Eigen::Vector3d(0, 0, world.board.piece_height_m + grip_height_m(world.board));
    stroke.duration_s = kCarry_s;
    stroke.arc_m = 0.06;
    stroke.end = StrokeEnd::crown;
    stroke.piece = piece;
    gestures_.add(stroke);
    withdraw(world);
    return;
  }
}

void Player::reach_for(const World& world, int piece) {
  const RealPiece& target = world.pieces[static_cast<std::size_t>(piece)];
  Stroke stroke;
  stroke.to_B = target.p_B + Eigen::Vector3d(0, 0, grip_height_m(world.board));
  stroke.duration_s = kReach_s + kFar_s_m * (stroke.to_B - hand_after_).norm();
  stroke.arc_m = 0.05;
  stroke.end = StrokeEnd::take;
  stroke.piece = piece;
  gestures_.add(stroke);
  hand_after_ = stroke.to_B;
  pause(world, kFingers_s);
}

void Player::carry(const World& world, int piece, const std::vector<int>& path) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Point3 centre = centre_of_square_B(path[i], world.board);
    const double off = 0.08 * world.board.square_size_m;
    Stroke stroke;
    stroke.foot_B = {centre[0] + random(-off, off), centre[1] + random(-off, off), 0};
    stroke.to_B = stroke.foot_B + Eigen::Vector3d(0, 0, grip_height_m(world.board));
    stroke.duration_s = i == 1 ? kCarry_s + kFar_s_m * (stroke.to_B - hand_after_).norm() : 0.4;
    stroke.arc_m = 0.045;
    stroke.piece = piece;
    stroke.square = path[i];
    if (i + 1 == path.size()) stroke.end = StrokeEnd::put_down;
    gestures_.add(stroke);
    hand_after_ = stroke.to_B;
  }
  pause(world, kFingers_s);
}

void Player::take_off(const World& world, int piece) {
  if (piece < 0) return;
  reach_for(world, piece);
  Stroke stroke;
  stroke.foot_B = place_beside_board(world.board, places_used_++);
  stroke.to_B = stroke.foot_B + Eigen::Vector3d(0, 0, grip_height_m(world.board));
  stroke.duration_s = kCarry_s + kFar_s_m * (stroke.to_B - hand_after_).norm();
  stroke.arc_m = 0.06;
  stroke.end = StrokeEnd::put_down;
  stroke.piece = piece;
  gestures_.add(stroke);
  hand_after_ = stroke.to_B;
}

void Player::withdraw(const World& world) {
  Stroke stroke;
  stroke.to_B = resting_hand(world.board);
  stroke.duration_s = kWithdraw_s;
  stroke.arc_m = 0.03;
  gestures_.add(stroke);
  hand_after_ = stroke.to_B;
}

void Player::pause(const World&, double seconds) {
  Stroke stroke;
  stroke.to_B = hand_after_;
  stroke.duration_s = seconds;
  gestures_.add(stroke);
}

}  // namespace counterpart::stage
