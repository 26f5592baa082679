#include "game_controller/programs/dxp.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <ostream>

#include <nlohmann/json.hpp>
#include <poll.h>
#include <unistd.h>

#include "game_controller/engine/endgame_cache.hpp"
#include "game_controller/engine/level.hpp"
#include "game_controller/links/dxp_game.hpp"
#include "game_controller/links/line_output.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/pdn_write.hpp"
#include "game_controller/rules/generate.hpp"
#include "protocol/codec/pdn_text.hpp"
#include "protocol/daemon/stop_signal.hpp"

namespace counterpart {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double connect_patience_s = 10;
constexpr double patience_with_reader_s = 1;
constexpr int moves_still_to_come = 40;  // when the clock is for the whole game

// What is typed, or written by the program that started us: "time 100", "quit".
class Instructions {
 public:
  explicit Instructions(double move_time_s) : move_time_s_(move_time_s) {}

  double move_time_s() const { return move_time_s_; }

  bool quit() {
    pollfd p{STDIN_FILENO, POLLIN, 0};
    while (open_ && !quit_ && ::poll(&p, 1, 0) > 0) {
      char block[256];
      const auto n = ::read(STDIN_FILENO, block, sizeof block);
      open_ = n > 0;
      for (long i = 0; i < n; ++i) {
        if (block[i] == '\n') {
          obey(line_);
          line_.clear();
        } else if (line_.size() < 100) {
          line_ += block[i];
        }
      }
    }
    return quit_ || stop_requested();
  }

 private:
  void obey(const std::string& line) {
    if (line.rfind("quit", 0) == 0 || line.rfind("exit", 0) == 0) quit_ = true;
    if (line.rfind("time ", 0) == 0) {
      const double milliseconds = std::strtod(line.c_str() + 5, nullptr);
      if (milliseconds > 0) move_time_s_ = milliseconds / 1000;
    }
  }

  double move_time_s_;
  bool open_ = true;
  bool quit_ = false;
  std::string line_;
};

class DxpProgram {
 public:
  DxpProgram(const DxpOptions& options, std::ostream& log)
      : options_(options),
        log_(log),
        instructions_(options.move_time_s),
        plan_(options.level > 0 ? plan_of_level(options.level) : LevelPlan{Evaluation::trained, 60, 0, 0}),
        searcher_(international_rules, plan_.evaluation, std::size_t{64} << 20) {
    player_.choose = [this](const Record& record, int minutes, int moves) {
      return choose_move(record, minutes, moves);
    };
    player_.on_move = [this](const Record& record, Side side, const std::string& peer) { save(record, side, peer); };
    player_.on_chat = [this](const std::string& text) { log_ << "chat: " << text << std::endl; };
    player_.give_up = [this] { return instructions_.quit(); };
    player_.patience_s = options.patience_s;
    if (options.level == 0) {
      endgames_.make_in_background(EndgameTables::most_pieces);
      searcher_.use_endgames(&endgames_.tables());
    }
  }

  Result<void> serve() {
    auto listener = Listener::open(options_.listen);
    if (!listener) return tl::make_unexpected(listener.error());
    log_ << "DXP: listening on port " << listener->port() << std::endl;
    while (!instructions_.quit() && !enough()) {
      auto channel = listener->accept(player_.give_up);
      if (!channel) break;
      while (!enough()) {
        begin_game();
        const auto game = answer_dxp_game(*channel, player_);
        if (!game) {
          log_ << "DXP: " << game.error().message << std::endl;
          break;
        }
        report(*game);
        if (game->stop) break;
      }
    }
    return {};
  }

  Result<void> visit() {
    auto channel = connect_to(options_.connect, connect_patience_s);
    if (!channel) return tl::make_unexpected(channel.error());
    DxpGameRequest request;
    request.name = player_.name;
    request.follower_side = options_.dark ? Side::light : Side::dark;
    request.minutes = options_.minutes;
    request.moves = options_.moves;
    if (!options_.fen.empty()) {
      const auto start = read_fen(international_rules, options_.fen);
      if (!start) return tl::make_unexpected(start.error());
      request.position = write_hub_position(international_rules, *start);
    }
    do {
      begin_game();
      const auto game = ask_for_dxp_game(*channel, request, player_);
      if (!game) return tl::make_unexpected(game.error());
      report(*game);
      if (game->stop) break;
    } while (played_ < std::max(options_.games, 1));
    return {};
  }

  void finish() {
    if (!results_.finish(patience_with_reader_s)) log_ << "DXP: nobody reads the results" << std::endl;
  }

 private:
  bool enough() const { return options_.games > 0 && played_ >= options_.games; }

  void begin_game() {
    searcher_.clear();
    used_s_ = 0;
  }

  // The clock's share of a move; a bound on thought where there is no clock.
  double time_for(const Record& record, int minutes, int moves) const {
    if (instructions_.move_time_s() > 0) return instructions_.move_time_s();
    const double left = std::max(60.0 * minutes - used_s_, 1.0);
    const int made = static_cast<int>(record.moves().size()) / 2;
    const int to_come = moves > made ? std::min(moves - made + 1, moves_still_to_come) : moves_still_to_come;
    return std::min(left / to_come, 60.0);
  }

  Move choose_move(const Record& record, int minutes, int moves) {
    const auto start = Clock::now();
    const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    static_cast<void>(instructions_.quit());
    const double time_s = time_for(record, minutes, moves);
    MoveList legal;
    generate(international_rules, record.position(), legal);
    if (legal.size() == 1) return legal[0];
    std::vector<std::uint64_t> earlier = record.keys();
    earlier.pop_back();
    const Choice choice = choose(searcher_, international_rules, record.position(), earlier, plan_, played_ + 1U,
                                 [&] { return elapsed() >= time_s || stop_requested(); });
    used_s_ += elapsed();
    return choice.best.move;
  }

  std::string pdn(const Record& record, GameResult result, Side side, const std::string& peer) const {
    PdnTags tags;
    tags.light = side == Side::light ? player_.name : peer;
    tags.dark = side == Side::light ? peer : player_.name;
    tags.round = std::to_string(played_ + 1);
    return write_pdn(tags, record, result) + "\n";
  }

  void save(const Record& record, Side side, const std::string& peer) {
    write(pdn(record, GameResult::open, side, peer));
  }

  void write(const std::string& last) {
    if (options_.pdn_file.empty()) return;
    std::ofstream file(options_.pdn_file, std::ios::trunc);
    file << finished_ << last;
    file.flush();
    if (!file) log_ << "DXP: the game could not be saved to " << options_.pdn_file << std::endl;
  }

  void report(const DxpResult& game) {
    if (!options_.pdn_file.empty()) finished_ += pdn(game.record, game.result, game.our_side, game.peer);
    write({});
    ++played_;
    nlohmann::ordered_json line;
    line["game"] = played_;
    line["peer"] = game.peer;
    line["we_play"] = game.our_side == Side::light ? "light" : "dark";
    line["result"] = pdn_result(game.result);
    line["why"] = game.why;
    line["plies"] = game.record.moves().size();
    results_.put(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }

  DxpOptions options_;
  LineOutput results_{STDOUT_FILENO};
  std::ostream& log_;
  Instructions instructions_;
  LevelPlan plan_;
  EndgameCache endgames_{international_rules};
  Searcher searcher_;
  DxpPlayer player_;
  int played_ = 0;
  double used_s_ = 0;
  std::string finished_;
};

}  // namespace

Result<void> run_dxp(const DxpOptions& options, std::ostream& log) {
  catch_stop_signals();
  DxpProgram program(options, log);
  auto played = options.listen.empty() ? program.visit() : program.serve();
  program.finish();
  return played;
}

}  // namespace counterpart
