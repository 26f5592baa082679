#include "game_controller/programs/play.hpp"

#include <cstdio>
#include <fstream>
#include <istream>
#include <ostream>

#include "game_controller/engine/level.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/notation/pdn_write.hpp"
#include "game_controller/referee/judge.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/record.hpp"
#include "protocol/codec/pdn_text.hpp"
#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {
namespace {

void draw(const Rules& rules, const Position& position, std::ostream& out) {
  const std::string squares = write_squares(rules, position);
  for (int row = 0; row < rules.squares; ++row) {
    for (int col = 0; col < rules.squares; ++col) {
      const auto square = square_of_cell({row, col}, rules.squares);
      const char piece = square ? squares[static_cast<std::size_t>(*square - 1)] : ' ';
      out << ' ' << (piece == 'e' ? '.' : piece);
    }
    const int per_row = rules.squares / 2;
    out << "   " << row * per_row + 1 << "-" << (row + 1) * per_row << "\n";
  }
}

class TerminalGame {
 public:
  TerminalGame(const Rules& rules, const PlayOptions& options, const Position& start, std::istream& in,
               std::ostream& out)
      : options_(options),
        in_(in),
        out_(out),
        record_(rules, start),
        plan_(plan_of_level(options.level)),
        searcher_(rules, plan_.evaluation, std::size_t{32} << 20) {}

  Result<void> play() {
    out_ << "Moves: 32-28, 28x19. Also: moves, hint, undo, board, resign, quit.\n";
    draw(rules(), record_.position(), out_);
    while (!record_.ending()) {
      if (person_to_move()) {
        if (!persons_turn()) break;
      } else {
        own_turn();
      }
      if (auto saved = save(); !saved) return saved;
    }
    if (const auto ending = record_.ending()) result_ = ending->result;
    if (result_ != GameResult::open) out_ << "Result: " << pdn_result(result_) << "\n";
    return save();
  }

 private:
  const Rules& rules() const { return record_.rules(); }
  bool person_to_move() const { return (record_.position().turn == Side::dark) == options_.dark; }

  Choice own_choice() {
    std::vector<std::uint64_t> earlier = record_.keys();
    earlier.pop_back();
    return choose(searcher_, rules(), record_.position(), earlier, plan_, 1);
  }

  void own_turn() {
    const Choice choice = own_choice();
    out_ << "I play " << pdn_text(rules(), record_.position(), choice.best.move) << "\n";
    record_.play(choice.best.move);
    draw(rules(), record_.position(), out_);
  }

  // False when the person ends the game.
  bool persons_turn() {
    std::string text;
    out_ << (options_.dark ? "dark> " : "light> ") << std::flush;
    if (!std::getline(in_, text) || text == "quit") return false;
    if (text == "moves") {
      for (const std::string& move : legal_moves_text(rules(), record_.position(), 500)) out_ << move << " ";
      out_ << "\n";
    } else if (text == "hint") {
      const Choice choice = own_choice();
      Position at = record_.position();
      for (const Move& move : choice.line) {
        out_ << pdn_text(rules(), at, move) << " ";
        at = after(rules(), at, move);
      }
      char score[16];
      std::snprintf(score, sizeof score, "%+.2f", choice.best.value / static_cast<double>(man_value));
      out_ << "(" << score << ")\n";
    } else if (text == "undo") {
      do {
        record_.undo();
      } while (!person_to_move() && !record_.moves().empty());
      draw(rules(), record_.position(), out_);
    } else if (text == "board") {
      draw(rules(), record_.position(), out_);
    } else if (text == "resign") {
      result_ = options_.dark ? GameResult::light_wins : GameResult::dark_wins;
      return false;
    } else if (!text.empty()) {
      const auto move = read_move(rules(), record_.position(), text);
      if (move) {
        record_.play(*move);
      } else {
        out_ << move.error().message << "\n";
      }
    }
    return true;
  }

  Result<void> save() const {
    if (options_.pdn_file.empty()) return {};
    PdnTags tags;
    tags.light = options_.dark ? "Counterpart" : "Player";
    tags.dark = options_.dark ? "Player" : "Counterpart";
    std::ofstream file(options_.pdn_file, std::ios::trunc);
    file << write_pdn(tags, record_, result_);
    file.flush();
    if (!file) return failure(ErrorCode::io, "The game could not be saved to " + options_.pdn_file + ".");
    return {};
  }

  PlayOptions options_;
  std::istream& in_;
  std::ostream& out_;
  Record record_;
  LevelPlan plan_;
  Searcher searcher_;
  GameResult result_ = GameResult::open;
};

}  // namespace

Result<void> play_in_terminal(const Rules& rules, const PlayOptions& options, std::istream& in, std::ostream& out) {
  Position start = start_position(rules);
  if (!options.fen.empty()) {
    const auto read = read_fen(rules, options.fen);
    if (!read) return tl::make_unexpected(read.error());
    start = *read;
  }
  return TerminalGame(rules, options, start, in, out).play();
}

}  // namespace counterpart
