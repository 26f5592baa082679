// draughts: counts moves, judges, plays, and talks to other draughts programs.
#include <bit>
#include <chrono>
#include <cstdio>
#include <functional>
#include <iostream>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "game_controller/engine/endgame_cache.hpp"
#include "game_controller/engine/level.hpp"
#include "game_controller/links/hub_engine.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/programs/arena.hpp"
#include "game_controller/programs/check.hpp"
#include "game_controller/programs/dxp.hpp"
#include "game_controller/programs/judge_lines.hpp"
#include "game_controller/programs/play.hpp"
#include "game_controller/programs/train.hpp"
#include "game_controller/rules/generate.hpp"

namespace {

using namespace counterpart;
using Clock = std::chrono::steady_clock;

constexpr int failed = 1;
constexpr int wrong_usage = 2;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int complain(const Error& error, int code) {
  std::cerr << "draughts: " << error.message << "\n";
  return code;
}

Result<Position> position_of(const Rules& rules, const std::string& fen) {
  return fen == "start" ? Result<Position>(start_position(rules)) : read_fen(rules, fen);
}

int run_perft(const Rules& rules, const std::string& fen, int depth) {
  const auto position = position_of(rules, fen);
  if (!position) return complain(position.error(), wrong_usage);
  for (int d = 1; d <= depth; ++d) {
    const auto start = Clock::now();
    const std::uint64_t count = perft(rules, *position, d);
    std::printf("%d %llu %.6f\n", d, static_cast<unsigned long long>(count), seconds_since(start));
    std::fflush(stdout);
  }
  return 0;
}

int run_best(const Rules& rules, const std::string& fen, double move_time_s) {
  const auto position = position_of(rules, fen);
  if (!position) return complain(position.error(), wrong_usage);
  if (!has_move(rules, *position)) {
    return complain({ErrorCode::invalid_argument, "there is no legal move in " + fen + "; the game is over there."},
                    failed);
  }
  auto start = Clock::now();
  Searcher searcher(rules, Evaluation::trained, std::size_t{64} << 20);
  EndgameCache endgames(rules);
  const Material material = material_of(*position);
  if (material.pieces() <= EndgameTables::most_pieces) endgames.make(material);
  searcher.use_endgames(&endgames.tables());
  SearchLimits limits;
  start = Clock::now();  // loading the tables is no thinking
  limits.give_up = [&] { return seconds_since(start) >= move_time_s; };
  const SearchReport report = searcher.search(*position, {}, limits);
  nlohmann::ordered_json best;
  best["move"] = pdn_text(rules, *position, report.line.front());
  best["hub"] = hub_text(rules, report.line.front());
  best["score"] = report.value / static_cast<double>(man_value);
  best["depth"] = report.depth;
  best["nodes"] = report.nodes;
  best["seconds"] = seconds_since(start);
  best["line"] = nlohmann::json::array();
  Position at = *position;
  for (const Move& move : report.line) {
    best["line"].push_back(pdn_text(rules, at, move));
    at = after(rules, at, move);
  }
  std::cout << best.dump() << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  CLI::App app{"Draughts: counts moves, judges, plays, and talks to other draughts programs."};
  app.set_version_flag("--version", std::string("draughts ") + COUNTERPART_VERSION);
  app.require_subcommand(1);
  std::string rules_name = "international";
  const auto with_rules = [&](CLI::App* command) {
    command->add_option("--rules", rules_name, "international (10x10), brazilian or english (8x8)")
        ->check(CLI::IsMember({"international", "brazilian", "english"}))
        ->capture_default_str();
    return command;
  };

  std::string fen = "start";
  int depth = 1;
  CLI::App* perft_command =
      with_rules(app.add_subcommand("perft", "Counts legal moves: depth, count and seconds, a line a depth"));
  perft_command->add_option("fen", fen, "position as FEN, or start")->required();
  perft_command->add_option("depth", depth, "plies")->required()->check(CLI::Range(1, 30));

  double move_time_s = 1;
  CLI::App* best_command = with_rules(app.add_subcommand("best", "Finds the best move; one JSON object"));
  best_command->add_option("fen", fen, "position as FEN, or start")->required();
  best_command->add_option("--move-time", move_time_s, "seconds")
      ->check(CLI::Range(0.001, 86'400.0))
      ->capture_default_str();

  CLI::App* judge_command = with_rules(app.add_subcommand(
      "judge", "Was it legal? Reads {\"before\",\"after\",\"light\"} a line, writes a verdict a line"));

  PlayOptions play;
  CLI::App* play_command = with_rules(app.add_subcommand("play", "Plays in the terminal"));
  play_command->add_option("--level", play.level, "strength, 1 to 8")->check(CLI::Range(1, 8))->capture_default_str();
  play_command->add_option("--fen", play.fen, "position to start from");
  play_command->add_option("--pdn", play.pdn_file, "file that the game is saved to as it goes");
  play_command->add_flag("--dark", play.dark, "you play the dark pieces");

  CLI::App* hub_command = app.add_subcommand("hub", "Is a Hub 2 engine on standard input and output");

  LessonOptions lesson_options;
  CLI::App* lessons_command = app.add_subcommand("lessons", "Plays games with itself to learn from");
  lessons_command->add_option("--out", lesson_options.out, "file of lessons; what it holds is gone on from")
      ->required();
  lessons_command->add_option("--games", lesson_options.games, "in the file in the end")->capture_default_str();
  lessons_command->add_option("--weights", lesson_options.weights, "file, or plain; default: the built-in ones");
  lessons_command->add_option("--depth", lesson_options.depth, "plies that each move is thought about")
      ->check(CLI::Range(2, 20))
      ->capture_default_str();
  lessons_command->add_option("--seed", lesson_options.seed, "of the games")->capture_default_str();

  FitFilesOptions fitting;
  CLI::App* fit_command = app.add_subcommand("fit", "Learns the weights of the evaluation from lessons");
  fit_command->add_option("lessons", fitting.lessons, "files that \"draughts lessons\" wrote")->required();
  fit_command->add_option("--out", fitting.out, "file for the weights")->required();
  fit_command->add_option("--start", fitting.start, "weights to go on from");
  fit_command->add_option("--epochs", fitting.epochs, "times that all lessons are gone through")->capture_default_str();
  fit_command->add_option("--trust", fitting.trust_in_search, "share of the search in what is learnt")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();

  std::string file;
  double most_leaves = 1e12;
  CLI::App* check_command =
      with_rules(app.add_subcommand("check", "Compares the rules with a file of known positions"));
  check_command->add_option("file", file, "JSON: {\"positions\": [{\"fen\", \"perft\" or \"legal\"}]}")->required();
  check_command->add_option("--most-leaves", most_leaves, "counts above this are left out");

  CLI::App* pdn_command = app.add_subcommand("pdn", "Reads a PDN file leniently, writes it strictly");
  pdn_command->add_option("file", file, "PDN file")->required();

  ArenaOptions arena;
  CLI::App* arena_command = app.add_subcommand("arena", "Measures two of its own players against each other");
  arena_command->add_option("--a", arena.a, "level:1-8, trained, plain, material or weights:FILE")
      ->capture_default_str();
  arena_command->add_option("--b", arena.b, "the same")->capture_default_str();
  arena_command->add_option("--games", arena.games, "an even number is fair")->capture_default_str();
  arena_command->add_option("--nodes", arena.nodes, "a move, for players that are no level")->capture_default_str();
  arena_command->add_option("--move-time", arena.move_time_s, "seconds a move instead of nodes")
      ->check(CLI::Range(0.0, 3'600.0));
  arena_command->add_option("--random-plies", arena.random_plies, "before each game")->capture_default_str();
  arena_command->add_option("--seed", arena.seed, "of the openings")->capture_default_str();

  DxpOptions dxp;
  CLI::App* dxp_command = app.add_subcommand("dxp", "Plays over DamExchange (DXP), as server or client");
  auto* listen_option = dxp_command->add_option("--listen", dxp.listen, "PORT (this machine only) or HOST:PORT");
  auto* connect_option = dxp_command->add_option("--connect", dxp.connect, "HOST:PORT of the program to play with");
  listen_option->excludes(connect_option);
  dxp_command->add_option("--level", dxp.level, "1 to 8; 0: full strength")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  dxp_command->add_option("--move-time", dxp.move_time_s, "seconds a move; 0: by the clock that was agreed on")
      ->check(CLI::Range(0.0, 86'400.0));
  dxp_command->add_option("--minutes", dxp.minutes, "each, asked for when connecting")->check(CLI::Range(1, 999));
  dxp_command->add_option("--moves", dxp.moves, "that the minutes are for; 0: the whole game")
      ->check(CLI::Range(0, 999));
  dxp_command->add_flag("--dark", dxp.dark, "we play the dark pieces (when connecting)");
  dxp_command->add_option("--fen", dxp.fen, "position to start from (when connecting)");
  dxp_command->add_option("--games", dxp.games, "then end; 0: no limit when listening, one when connecting");
  dxp_command->add_option("--patience", dxp.patience_s, "seconds that the other side may be silent")
      ->check(CLI::Range(1.0, 1e6));
  dxp_command->add_option("--pdn", dxp.pdn_file, "file that every game is saved to as it goes");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : wrong_usage;
  }
  const Rules& rules = *find_rules(rules_name);
  if (perft_command->parsed()) return run_perft(rules, fen, depth);
  if (best_command->parsed()) return run_best(rules, fen, move_time_s);
  if (judge_command->parsed()) return judge_lines(rules, std::cin, std::cout) ? 0 : failed;
  if (play_command->parsed()) {
    const auto played = play_in_terminal(rules, play, std::cin, std::cout);
    return played ? 0 : complain(played.error(), failed);
  }
  if (lessons_command->parsed()) {
    const auto played = play_lessons_to_file(lesson_options, std::cerr);
    return played ? 0 : complain(played.error(), failed);
  }
  if (fit_command->parsed()) {
    const auto fitted = fit_files(fitting, std::cerr);
    return fitted ? 0 : complain(fitted.error(), failed);
  }
  if (check_command->parsed()) {
    const auto right = check_positions(rules, file, most_leaves, std::cout);
    return !right ? complain(right.error(), failed) : *right ? 0 : failed;
  }
  if (pdn_command->parsed()) {
    const auto written = rewrite_pdn(file, std::cout);
    return written ? 0 : complain(written.error(), failed);
  }
  if (arena_command->parsed()) {
    const auto measured = run_arena(arena, std::cout, std::cerr);
    return measured ? 0 : complain(measured.error(), wrong_usage);
  }
  if (dxp_command->parsed()) {
    if (dxp.listen.empty() == dxp.connect.empty()) {
      return complain({ErrorCode::invalid_argument, "dxp needs --listen PORT or --connect HOST:PORT"}, wrong_usage);
    }
    const auto played = run_dxp(dxp, std::cerr);
    return played ? 0 : complain(played.error(), failed);
  }
  if (hub_command->parsed()) {
    EndgameCache endgames(international_rules);
    endgames.make_in_background(EndgameTables::most_pieces);
    run_hub_engine(std::cin, std::cout, &endgames.tables());
  }
  return 0;
}
