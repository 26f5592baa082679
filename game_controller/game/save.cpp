// A game as JSON text, so that it survives the process that plays it.
#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "game_controller/game/state.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

using nlohmann::json;

constexpr int save_version = 1;
constexpr std::size_t longest_save = 1 << 20;
constexpr std::size_t most_saved_moves = 5'000;

tl::unexpected<Error> unusable(const std::string& why) {
  return failure(ErrorCode::bad_format, "The saved game cannot be used: " + why + ". Delete it to start afresh.");
}

template <class E>
E checked_enum(const json& saved, const char* name, int lowest, int highest) {
  const int value = saved.at(name).get<int>();
  if (value < lowest || value > highest) throw std::out_of_range(std::string(name) + " is out of range");
  return static_cast<E>(value);
}

}  // namespace

std::string Game::save() const {
  const State& s = *state_;
  json saved;
  saved["version"] = save_version;
  saved["rules"] = s.rules->name;
  saved["virtual_side"] = static_cast<int>(s.options.virtual_side);
  saved["start"] = write_hub_position(*s.rules, s.record.start());
  saved["moves"] = json::array();
  for (const Move& move : s.record.moves()) saved["moves"].push_back(hub_text(*s.rules, move));
  saved["phase"] = static_cast<int>(s.phase);
  saved["behind"] = static_cast<int>(s.behind);
  saved["result"] = static_cast<int>(s.result);
  saved["result_code"] = s.result_code;
  saved["started"] = s.started;
  saved["pending"] = s.pending ? json(hub_text(*s.rules, s.pending->move)) : json(nullptr);
  saved["second_try"] = s.pending && s.pending->second_try;
  saved["to_remove"] = s.squares(s.to_remove);
  saved["revision"] = s.revision;
  saved["scene_revision"] = s.scene_revision;
  saved["next_event"] = s.next_event;
  saved["next_command"] = s.human.next_id();
  return saved.dump();
}

Result<Game> Game::resume(const GameOptions& options, const std::string& text) {
  if (text.size() > longest_save) return unusable("it is too large");
  try {
    const json saved = json::parse(text);
    if (saved.at("version").get<int>() != save_version) return unusable("it is of another version of this program");
    GameOptions kept = options;
    kept.rules = saved.at("rules").get<std::string>();
    kept.virtual_side = checked_enum<Side>(saved, "virtual_side", 1, 2);
    const Rules* rules = find_rules(kept.rules);
    if (rules == nullptr || kept.board.squares != rules->squares)
      return unusable("it is of another board or other rules");
    const auto start = read_hub_position(*rules, saved.at("start").get<std::string>());
    if (!start) return unusable(start.error().message);
    auto state = std::make_unique<State>(kept, *rules, *start, saved.at("next_command").get<std::uint64_t>());
    State& s = *state;
    if (saved.at("moves").size() > most_saved_moves) return unusable("it has too many moves");
    for (const json& word : saved.at("moves")) {
      const auto move = read_move(*rules, s.record.position(), word.get<std::string>(), MoveStyle::hub);
      if (!move) return unusable(move.error().message);
      s.record.play(*move);
    }
    s.name_pieces();
    s.phase = checked_enum<GamePhase>(saved, "phase", 1, 7);
    s.behind = checked_enum<GamePhase>(saved, "behind", 1, 7);
    s.result = checked_enum<GameResult>(saved, "result", 1, 4);
    s.result_code = saved.at("result_code").get<std::string>();
    s.started = saved.at("started").get<bool>();
    if (s.phase == GamePhase::illegal) s.phase = s.behind;  // one looks again and says so again
    const GamePhase real_phase = s.phase == GamePhase::paused ? s.behind : s.phase;
    const bool virtual_turn = s.record.position().turn == kept.virtual_side;
    if ((real_phase == GamePhase::virtual_to_move) != virtual_turn && real_phase != GamePhase::setting_up &&
        real_phase != GamePhase::over) {
      return unusable("its phase does not fit its turn");
    }
    if (!saved.at("pending").is_null() && real_phase == GamePhase::virtual_to_move) {
      const auto move = read_move(*rules, s.record.position(), saved.at("pending").get<std::string>(), MoveStyle::hub);
      if (!move) return unusable(move.error().message);
      // Told again as soon as a renderer is there; until then as if its hand were on the way.
      s.pending = PendingMove{*move, s.human.next_id() - 1, saved.at("second_try").get<bool>(), -1};
    }
    s.ask_engine = real_phase == GamePhase::virtual_to_move && !s.pending;
    for (const json& square : saved.at("to_remove")) {
      const int number = square.get<int>();
      if (!is_square(number, rules->squares)) return unusable("it names a square that does not exist");
      s.to_remove |= square_mask(number, rules->squares);
    }
    s.revision = saved.at("revision").get<std::uint64_t>();
    s.scene_revision = saved.at("scene_revision").get<std::uint64_t>();
    s.next_event = saved.at("next_event").get<std::uint64_t>();
    s.shown = s.board_state();
    s.shown.revision = s.revision;
    return Game(std::move(state));
  } catch (const std::exception& e) {
    return unusable(e.what());
  }
}

}  // namespace counterpart
