// What the game makes of what the camera sees.
#include <algorithm>
#include <bit>

#include "game_controller/game/state.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/referee/judge.hpp"
#include "game_controller/referee/sentences.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

Bits turned_round(Bits bits, int n) {
  Bits turned = 0;
  for (; bits != 0; bits &= bits - 1) {
    turned |= square_mask(playable_squares(n) + 1 - square_of_bit(lowest(bits), n), n);
  }
  return turned;
}

// Why the board may not look so while it is not the real player's turn.
const char* idle_reason(Bits gone, Bits fresh, const std::vector<Cell>& strays) {
  if (!strays.empty()) return "light_square";
  if (std::popcount(fresh) > std::popcount(gone)) return "piece_appeared";
  return fresh == 0 ? "piece_vanished" : "not_your_turn";
}

}  // namespace

// Where something else stands than should, as far as that is seen.
Bits Game::State::wrong_squares(const Reading& reading, const Position& expected) const {
  Bits wrong = reading.occupied ^ real_pieces(expected);
  if (options.both_real) wrong |= reading.light ^ expected.light;
  return wrong & ~reading.unknown;
}

bool Game::State::differs(const Reading& reading, const Position& expected) const {
  return wrong_squares(reading, expected) != 0 || !reading.strays.empty();
}

// How the board will stand when the virtual player's move has been made for him.
std::optional<Position> Game::State::asked_for() const {
  if (!options.both_real || !pending) return std::nullopt;
  return after(*rules, record.position(), pending->move);
}

// A square that glares for good must not stop the game; a board half out of the picture may hide anything.
bool Game::State::nearly_all_seen(const Reading& reading) const {
  return std::popcount(reading.unknown) * 10 <= playable_squares(rules->squares);
}

bool Game::State::settled() const {
  return eyes.steady_ns(now_ns) >= options.settle_ns;
}

// True when something new is wrong or it is time to say it again.
bool Game::State::reminding() {
  if (announced && agree(*announced, eyes.reading()) && now_ns - reminded_ns < options.remind_ns) return false;
  announced = eyes.reading();
  reminded_ns = now_ns;
  return true;
}

void Game::State::look() {
  const Reading& reading = eyes.reading();
  if (!reading.covered && reading.unknown == 0) remember_stop(reading);
  if (eyes.steady_ns(now_ns) < options.stable_ns) return;
  switch (phase) {
    case GamePhase::setting_up:
      return look_at_set_up(reading);
    case GamePhase::real_to_move:
      return look_for_move(reading);
    case GamePhase::virtual_to_move:
      return look_while_waiting(reading);
    case GamePhase::waiting_for_removal:
      return look_for_removal(reading);
    case GamePhase::illegal:
      return look_at_wrong_board(reading);
    case GamePhase::paused:
    case GamePhase::over:
      return;
  }
}

void Game::State::look_at_set_up(const Reading& reading) {
  const Position& expected = record.position();
  if (!differs(reading, expected)) {
    if (reading.unknown == 0) return begin();
    if (settled() && nearly_all_seen(reading)) return begin();
    if (settled()) report_unclear(reading.unknown);
    return;
  }
  if (!settled() || !reminding()) return;
  const Bits wrong = wrong_squares(reading, expected);
  GameEvent& e = event(EventKind::set_up_wrong);
  e.side = real_side();
  e.squares = squares(wrong);
  if (!reading.strays.empty()) e.code = "light_square";
  const bool turned = reading.strays.empty() && reading.occupied == turned_round(real_pieces(), rules->squares) &&
                      (!options.both_real || reading.light == turned_round(expected.light, rules->squares));
  if (turned && reading.occupied != 0) e.code = "board_turned";
  human.say("set_up", sentence(turned ? "board_turned" : "set_up", e.squares));
}

void Game::State::look_for_move(const Reading& reading) {
  if (!differs(reading, record.position())) {
    const bool for_long = eyes.steady_ns(now_ns) >= options.remind_ns;
    if (reading.unknown != 0 && for_long) report_unclear(reading.unknown);
    return;
  }
  if (try_moves(reading) || !settled()) return;
  const Verdict verdict = judge_reading(reading);
  const bool may_be_hidden = verdict.move || verdict.reason == "piece_vanished" || verdict.reason == "no_change" ||
                             !fitting_moves(reading).empty();
  if (reading.unknown != 0 && may_be_hidden) {
    report_unclear(reading.unknown);
  } else if (!verdict.move) {
    object(reading, verdict.reason, verdict.squares);
  }
}

// What is not seen is taken to be as it was.
Verdict Game::State::judge_reading(const Reading& reading) const {
  const Position& before = record.position();
  const Bits occupied = (reading.occupied & ~reading.unknown) | (real_pieces() & reading.unknown);
  if (!options.both_real) return judge_own(*rules, before, occupied, reading.strays);
  Position seen = before;
  seen.light = occupied & ((reading.light & ~reading.unknown) | (before.light & reading.unknown));
  seen.dark = occupied & ~seen.light;
  // A piece does not show that it is a king: the one that has moved keeps what it was.
  const Bits own_before = pieces_of(before, before.turn), own_now = pieces_of(seen, before.turn);
  seen.kings &= (seen.light & before.light) | (seen.dark & before.dark);
  if ((before.kings & own_before & ~own_now) != 0) seen.kings |= own_now & ~own_before;
  return judge(*rules, before, seen, reading.strays);
}

// The legal moves after which the board would look so, as far as it is seen.
std::vector<Move> Game::State::fitting_moves(const Reading& reading) const {
  std::vector<Move> fitting;
  MoveList legal;
  generate(*rules, record.position(), legal);
  for (const Move& move : legal) {
    const bool shows = move.from != move.to || options.both_real;  // once round and back: only in what was captured
    if (shows && !differs(reading, after(*rules, record.position(), move))) fitting.push_back(move);
  }
  return fitting;
}

// Plays the legal move that the board shows, if there is one and its ends are both seen.
bool Game::State::try_moves(const Reading& reading) {
  if (!nearly_all_seen(reading)) return false;
  const Bits mine = real_pieces();
  std::vector<Move> fitting = fitting_moves(reading);
  std::erase_if(fitting, [&](const Move& move) {
    const Bits taken_off = options.both_real ? move.captured : 0;
    return ((one(move.from) | one(move.to) | taken_off) & reading.unknown) != 0;
  });
  if (fitting.empty()) return false;
  if (fitting.size() > 1) {
    const auto passed = [&](const Move& move) {
      for (const Route& way : routes(*rules, record.position(), move)) {
        for (std::size_t i = 1; i + 1 < way.squares.size(); ++i) {
          const Bits stop = (mine & ~one(move.from)) | square_mask(way.squares[i], rules->squares);
          if (std::find(stops.begin(), stops.end(), stop) != stops.end()) return true;
        }
      }
      return false;
    };
    std::vector<Move> seen_on_the_way;
    std::copy_if(fitting.begin(), fitting.end(), std::back_inserter(seen_on_the_way), passed);
    if (seen_on_the_way.size() != 1) {
      if (reminding()) {
        GameEvent& e = event(EventKind::board_unclear);
        e.code = "which_capture";
        e.squares = {square_of_bit(fitting.front().from, rules->squares),
                     square_of_bit(fitting.front().to, rules->squares)};
        for (const Move& move : fitting) e.legal.push_back(path_text(*rules, record.position(), move));
        human.say("which_capture", sentence("which_capture", {}));
      }
      return true;
    }
    fitting = seen_on_the_way;
  }
  if (phase == GamePhase::illegal) event(EventKind::board_restored).side = real_side();
  commit(fitting.front());
  show_scene();
  hand_over();
  return true;
}

void Game::State::look_while_waiting(const Reading& reading) {
  if (options.both_real) return look_for_favour(reading);
  // He may already be taking off what is about to be captured.
  const Bits tolerated = pending ? pending->move.captured : 0;
  const Bits mine = real_pieces();
  const Bits wrong = (reading.occupied ^ mine) & ~reading.unknown & ~tolerated;
  if ((wrong == 0 && reading.strays.empty()) || !settled()) return;
  object(reading, idle_reason(wrong & mine, wrong & ~mine, reading.strays), squares(wrong));
}

// All pieces are real: has his move been made for him?
void Game::State::look_for_favour(const Reading& reading) {
  const auto asked = asked_for();
  if (asked && nearly_all_seen(reading) && !differs(reading, *asked)) {
    const Bits concerned = one(pending->move.from) | one(pending->move.to) | pending->move.captured;
    if ((concerned & reading.unknown) == 0) return landed();
  }
  if (!settled()) return;
  const Position& before = record.position();
  if (!differs(reading, before)) {
    if (asked && now_ns - pending->told_ns >= options.remind_ns) ask_to_move();
    return;
  }
  const Bits wrong = wrong_squares(reading, before);
  const Bits his = pieces_of(before, options.virtual_side) | (asked ? pieces_of(*asked, options.virtual_side) : 0);
  if (!reading.strays.empty()) return object(reading, "light_square", squares(wrong));
  if (reading.unknown != 0 && asked && !differs(reading, *asked)) return report_unclear(reading.unknown);
  object(reading, (wrong & his) == 0 || !asked ? "not_your_turn" : "not_as_asked", squares(wrong));
}

void Game::State::look_for_removal(const Reading& reading) {
  const Bits mine = real_pieces();
  const Bits left = (reading.occupied | reading.unknown) & to_remove;
  const Bits wrong = (reading.occupied ^ mine) & ~reading.unknown & ~to_remove;
  if (wrong == 0 && reading.strays.empty()) {
    if (left == 0) {
      removal_done();
    } else if (now_ns - reminded_ns >= options.remind_ns) {
      ask_for_removal(true);
    }
    return;
  }
  if (left == 0 && reading.strays.empty() && !matching_moves(*rules, record.position(), reading.occupied).empty()) {
    // Taken off and moved at once.
    removal_done();
    try_moves(reading);
    return;
  }
  if (!settled()) return;
  if (left != 0 && (wrong & ~mine) != 0 && reading.strays.empty()) {
    object(reading, "captured_left_on_board", squares(left));
    return;
  }
  const char* reason = idle_reason(wrong & mine, wrong & ~mine, reading.strays);
  object(reading, reason == std::string("piece_vanished") ? "extra_piece_removed" : reason, squares(wrong));
}

void Game::State::look_at_wrong_board(const Reading& reading) {
  Bits tolerated = 0;
  if (behind == GamePhase::waiting_for_removal) tolerated = to_remove;
  if (behind == GamePhase::virtual_to_move && pending && !options.both_real) tolerated = pending->move.captured;
  Reading judged = reading;
  judged.unknown |= tolerated;
  // What was wrong and cannot be seen now may still be so.
  if (announced && (wrong_squares(*announced, record.position()) & reading.unknown) != 0) {
    if (settled() && now_ns - reminded_ns >= options.remind_ns) {
      reminded_ns = now_ns;
      human.say("put_back", sentence("put_back", {}));
    }
    return;
  }
  if (!differs(judged, record.position())) return put_right();
  if (const auto asked = asked_for(); asked && behind == GamePhase::virtual_to_move && !differs(reading, *asked)) {
    put_right();
    return look_for_favour(reading);
  }
  if (behind == GamePhase::real_to_move && try_moves(reading)) return;
  if (!settled()) return;
  if (announced && !agree(*announced, reading)) {
    // Something else is wrong now: look again as if nothing had been said.
    phase = behind;
    look();
    if (phase == behind) phase = GamePhase::illegal;
  } else if (reminding()) {
    human.say("put_back", sentence("put_back", {}));
  }
}

void Game::State::object(const Reading& reading, const std::string& reason, const std::vector<int>& about) {
  if (phase != GamePhase::illegal) behind = phase;
  phase = GamePhase::illegal;
  announced = reading;
  reminded_ns = now_ns;
  GameEvent& e = event(EventKind::illegal_move);
  e.side = real_side();
  e.code = reason;
  e.squares = about;
  if (real_to_move()) e.legal = legal_moves_text(*rules, record.position());
  const char* words = behind == GamePhase::waiting_for_removal && reason == "captured_left_on_board" ? "remove_captured"
                                                                                                     : reason.c_str();
  human.object(reason, sentence(words, about, e.legal), about.empty() ? 0 : about.front());
}

void Game::State::put_right() {
  event(EventKind::board_restored).side = real_side();
  phase = behind;
  announced.reset();
  stops.clear();
}

void Game::State::remember_stop(const Reading& reading) {
  constexpr std::size_t most_stops = 64;
  if (!real_to_move() || reading.occupied == real_pieces()) return;
  if (!stops.empty() && stops.back() == reading.occupied) return;
  if (stops.size() < most_stops) stops.push_back(reading.occupied);
}

void Game::State::report_unclear(Bits concerned) {
  if (!reminding()) return;
  GameEvent& e = event(EventKind::board_unclear);
  e.squares = squares(concerned);
  human.say("board_unclear", sentence("board_unclear", e.squares));
}

}  // namespace counterpart
