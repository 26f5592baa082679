// What a person asks of the game.
#include <utility>

#include "game_controller/game/state.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"

namespace counterpart {

void Game::State::obey(const Control& control) {
  switch (control.kind) {
    case ControlKind::new_game: {
      if (control.text.empty()) return restart(start_position(*rules));
      const auto start = read_fen(*rules, control.text);
      if (!start) {
        out.rejected.push_back("No new game: " + start.error().message);
        return;
      }
      return restart(*start);
    }
    case ControlKind::undo:
      return take_back();
    case ControlKind::resign:
      if (phase == GamePhase::over) {
        out.rejected.push_back("The game is over already; start a new one.");
        return;
      }
      return finish({options.virtual_side == Side::light ? GameResult::light_wins : GameResult::dark_wins, "resigned"});
    case ControlKind::pause:
      if (phase == GamePhase::paused || phase == GamePhase::over) return;
      // A board that was wrong is looked at afresh afterwards.
      if (phase != GamePhase::illegal) behind = phase;
      phase = GamePhase::paused;
      return;
    case ControlKind::resume:
      if (phase == GamePhase::paused) phase = behind;
      return;
    case ControlKind::read_again:
      eyes.forget();
      announced.reset();
      stops.clear();
      if (phase == GamePhase::illegal) phase = behind;
      return;
    case ControlKind::it_was:
      return it_was(control.text);
    case ControlKind::swap_sides:
      options.virtual_side = real_side();
      return restart(record.start());
    case ControlKind::hint:
      return hint(control.text);
    case ControlKind::level:
    case ControlKind::corners:
    case ControlKind::quit:
      return;  // for others
  }
}

// Back to before the real player's last move; the board has to be put so first.
void Game::State::take_back() {
  std::size_t plies = record.moves().size();
  while (plies > 0 && record.position_before(plies - 1).turn != real_side()) --plies;
  if (plies == 0) {
    out.rejected.push_back("There is no move of yours to take back yet.");
    return;
  }
  if (pending || thinking || lost.under_way()) human.stop();
  while (record.moves().size() >= plies) record.undo();
  GameEvent& e = event(EventKind::undone);
  e.side = real_side();
  name_pieces();
  phase = behind = GamePhase::setting_up;
  result = GameResult::open;
  result_code.clear();
  thinking = ask_engine = false;
  pending.reset();
  to_remove = 0;
  announced.reset();
  stops.clear();
  show_scene();
}

void Game::State::it_was(const std::string& text) {
  const bool replacing = phase == GamePhase::virtual_to_move && thinking && !record.moves().empty();
  const bool asked = real_to_move() && (phase == GamePhase::real_to_move || phase == GamePhase::illegal);
  if (!replacing && !asked) {
    out.rejected.push_back("No move of yours can be named now; take the last one back first.");
    return;
  }
  const Position& before =
      replacing ? record.position_before(record.moves().size() - 1) : std::as_const(record).position();
  const auto move = read_move(*rules, before, text);
  if (!move) {
    out.rejected.push_back(move.error().message);
    return;
  }
  if (replacing) {
    if (lost.under_way()) human.stop();
    record.undo();
    name_pieces();
    event(EventKind::undone).side = real_side();
    thinking = false;
  }
  if (phase == GamePhase::illegal) event(EventKind::board_restored).side = real_side();
  commit(*move);
  show_scene();
  hand_over();
}

}  // namespace counterpart
