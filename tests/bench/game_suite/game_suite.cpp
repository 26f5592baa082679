// Plays many games between a simulated player on the stage and the system, and prints how well the system understood
// them. Exit code 0: every record equals the truth and no move was committed wrongly; 1: not so; 2: wrong usage.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "protocol/daemon/stop_signal.hpp"
#include "tests/bench/game_suite/plan.hpp"
#include "tests/bench/game_suite/summary.hpp"

namespace counterpart::bench {
namespace {

struct SuiteOptions {
  int games = 5;
  int first = 1;
  int plies = 30;
  int jobs = 1;
  std::uint64_t seed = 1;
  std::vector<std::string> methods{"appearance"};
  std::string out;
  std::string log;
};

struct Task {
  int game;
  std::string method;
};

Result<Played> play(const Task& task, const SuiteOptions& options) {
  PlayOptions play;
  play.plies = options.plies;
  play.method = task.method == "appearance" ? ReadingMethod::appearance : ReadingMethod::scan_segments;
  play.stop = stop_requested;
  std::ofstream log;
  if (!options.log.empty()) {
    const std::string name = options.log + "/game-" + std::to_string(task.game) + "-" + task.method + ".log";
    log.open(name);
    if (!log) return failure(ErrorCode::io, "cannot write " + name);
    play.log = &log;
  }
  return play_game(plan_game(options.seed, task.game, options.plies), play);
}

// A process of its own for each job: drawing and reading share nothing. Plays every jobs-th task; a line of JSON each.
void work(const std::vector<Task>& tasks, const SuiteOptions& options, int job, std::FILE* answers) {
  cv::setNumThreads(1);
  setenv("LP_NUM_THREADS", "0", 0);  // Mesa's software driver draws in this thread
  for (std::size_t i = static_cast<std::size_t>(job); i < tasks.size() && !stop_requested();
       i += static_cast<std::size_t>(options.jobs)) {
    nlohmann::json answer{{"method", tasks[i].method}};
    const auto played = play(tasks[i], options);
    if (stop_requested()) return;
    if (played) {
      answer["played"] = to_json(*played);
    } else {
      answer["error"] = played.error().message;
    }
    std::fprintf(answers, "%s\n", answer.dump().c_str());
    std::fflush(answers);
  }
}

// Returns where the answers of all jobs come from, or a null pointer.
std::FILE* start(const std::vector<Task>& tasks, const SuiteOptions& options) {
  int ends[2];
  if (pipe(ends) != 0) return nullptr;
  for (int job = 0; job < options.jobs; ++job) {
    const pid_t child = fork();
    if (child < 0) return nullptr;
    if (child > 0) continue;
    close(ends[0]);
    std::FILE* answers = fdopen(ends[1], "w");
    work(tasks, options, job, answers);
    std::fclose(answers);
    std::_Exit(0);
  }
  close(ends[1]);
  return fdopen(ends[0], "r");
}

void tell(const Played& game, const std::string& method, std::size_t done, std::size_t all) {
  std::fprintf(stderr, "[%zu/%zu] %s, %s: %d moves, %s%s%s\n", done, all, game.name.c_str(), method.c_str(), game.plies,
               game.equal ? "equal" : "NOT equal", game.trouble.empty() ? "" : ": ", game.trouble.c_str());
}

int run(const SuiteOptions& options) {
  std::vector<Task> tasks;
  for (int game = options.first; game < options.first + options.games; ++game)
    for (const std::string& method : options.methods) tasks.push_back({game, method});
  catch_stop_signals();
  std::FILE* answers = start(tasks, options);
  if (answers == nullptr) {
    std::fprintf(stderr, "game_suite: cannot start %d processes; fewer --jobs may help\n", options.jobs);
    return 1;
  }
  std::map<std::string, std::vector<Played>> games;
  std::size_t done = 0;
  char* line = nullptr;
  std::size_t capacity = 0;
  while (getline(&line, &capacity, answers) > 0) {
    const nlohmann::json answer = nlohmann::json::parse(line);
    if (answer.contains("error")) {
      std::fprintf(stderr, "game_suite: %s\n", answer["error"].get<std::string>().c_str());
      continue;
    }
    const std::string method = answer.at("method");
    games[method].push_back(played_from(answer.at("played")));
    tell(games[method].back(), method, ++done, tasks.size());
  }
  std::free(line);
  std::fclose(answers);
  while (wait(nullptr) > 0) {
  }

  nlohmann::json report;
  bool all_well = done == tasks.size();
  for (const auto& [method, played] : games) {
    report[method] = summary_of(played);
    all_well = all_well && report[method]["equal"] == played.size() && report[method]["wrong_commits"] == 0;
  }
  std::printf("%d games of %d moves, seed %llu\n%s", options.games, options.plies,
              static_cast<unsigned long long>(options.seed), table_of(report).c_str());
  if (done < tasks.size()) std::fprintf(stderr, "game_suite: %zu games were not played\n", tasks.size() - done);
  if (!options.out.empty()) {
    std::ofstream file(options.out);
    file << nlohmann::json{{"seed", options.seed}, {"plies", options.plies}, {"methods", report}}.dump(1) << '\n';
    if (!file.flush()) {
      std::fprintf(stderr, "game_suite: cannot write %s\n", options.out.c_str());
      return 1;
    }
  }
  return all_well ? 0 : 1;
}

}  // namespace
}  // namespace counterpart::bench

int main(int argc, char** argv) {
  using namespace counterpart::bench;
  SuiteOptions options;
  CLI::App app(
      "Plays games between a simulated player on the stage and the system: camera pictures, tracker, reader, "
      "referee and game in one process. The system sees pictures only; the truth is looked at afterwards.",
      "game_suite");
  app.add_option("--games", options.games, "how many")->check(CLI::Range(1, 100'000))->capture_default_str();
  app.add_option("--first", options.first, "number of the first game")->check(CLI::Range(0, 1'000'000));
  app.add_option("--moves", options.plies, "of both sides, a game")->check(CLI::Range(2, 500))->capture_default_str();
  app.add_option("--seed", options.seed, "of everything that is drawn by chance")->capture_default_str();
  app.add_option("--jobs", options.jobs, "processes at the same time")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--method", options.methods, "ways of reading the squares, side by side: appearance, scan-segments")
      ->delimiter(',')
      ->check(CLI::IsMember({"appearance", "scan-segments"}));
  app.add_option("--out", options.out, "the figures as JSON");
  app.add_option("--log", options.log, "a folder: what happened in each game, a file each")
      ->check(CLI::ExistingDirectory);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return run(options);
}
