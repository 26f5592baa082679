#include "game_controller/links/hub_engine.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <istream>
#include <memory>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>

#include "game_controller/engine/level.hpp"
#include "game_controller/engine/search.hpp"
#include "game_controller/links/hub_line.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/record.hpp"

namespace counterpart {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_hub_moves = 5'000;
constexpr double reserve_s = 0.003;  // for the way of the answer

std::string number(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

struct Level {
  int depth = 60;
  std::uint64_t nodes = 0;
  double hard_s = 0;  // 0: no limit
  double soft_s = 0;
};

class HubEngine {
 public:
  HubEngine(std::istream& in, std::ostream& out, const EndgameTables* endgames)
      : in_(in), out_(out), tied_(in.tie(nullptr)), endgames_(endgames), record_(rules_, start_position(rules_)) {}
  ~HubEngine() {
    stop_search();
    in_.tie(tied_);
  }
  HubEngine(const HubEngine&) = delete;
  HubEngine& operator=(const HubEngine&) = delete;

  void run() {
    std::string text;
    while (std::getline(in_, text)) {
      const auto line = read_hub_line(text);
      if (!line) {
        error(line.error().message);
      } else if (!obey(*line)) {
        return;
      }
    }
  }

 private:
  bool obey(const HubLine& line) {
    const std::string& command = line.command;
    if (command == "quit") return false;
    if (command == "ping") {
      put("pong");
    } else if (command == "stop") {
      stop_search();
    } else if (command == "ponder-hit") {
      ponder_hit();
    } else if (command == "hub" || command == "set-param" || command == "init" || command == "new-game" ||
               command == "pos" || command == "level" || command == "go") {
      // Only the three above are allowed during a search; these end it, so that no answer belongs to an old position.
      stop_search();
      prepare(command, line);
    }  // others are ignored, as the protocol demands
    return true;
  }

  void prepare(const std::string& command, const HubLine& line) {
    if (command == "hub") {
      introduce();
    } else if (command == "set-param") {
      set_parameter(line);
    } else if (command == "init") {
      searcher();
      put("ready");
    } else if (command == "new-game") {
      searcher().clear();
    } else if (command == "pos") {
      set_position(line);
    } else if (command == "level") {
      set_level(line);
    } else if (command == "go") {
      go(line);
    }
  }

  void introduce() {
    put(write_hub_line(HubLine{"id", {}}
                           .with("name", "Counterpart")
                           .with("version", COUNTERPART_VERSION)
                           .with("author", "the Counterpart project")));
    put("param name=level value=0 type=int min=0 max=8");
    put("param name=evaluation value=" + std::string(name_of(evaluation_)) +
        " type=enum values=\"trained plain material\"");
    put("param name=hash-mb value=" + std::to_string(hash_mb_) + " type=int min=1 max=4096");
    put("wait");
  }

  void set_parameter(const HubLine& line) {
    const std::string* name = line.find("name");
    const std::string* value = line.find("value");
    if (name == nullptr || value == nullptr) return error("set-param needs name and value");
    if (*name == "level") {
      const auto level = hub_number(*value, 0, highest_level);
      if (!level) return error("level must be 0 (full strength) to 8");
      level_of_play_ = static_cast<int>(*level);
    } else if (*name == "evaluation") {
      const auto evaluation = find_evaluation(*value);
      if (!evaluation) return error("evaluation must be trained, plain or material");
      evaluation_ = *evaluation;
    } else if (*name == "hash-mb") {
      const auto mb = hub_number(*value, 1, 4096);
      if (!mb) return error("hash-mb must be 1 to 4096");
      hash_mb_ = static_cast<int>(*mb);
    } else {
      return;  // of another engine
    }
    searcher_.reset();
  }

  Searcher& searcher() {
    if (!searcher_) {
      const Evaluation evaluation = level_of_play_ > 0 ? plan_of_level(level_of_play_).evaluation : evaluation_;
      searcher_ = std::make_unique<Searcher>(rules_, evaluation, static_cast<std::size_t>(hash_mb_) << 20);
      searcher_->use_endgames(endgames_);
    }
    return *searcher_;
  }

  void set_position(const HubLine& line) {
    has_position_ = false;
    const std::string* text = line.find("pos");
    if (text == nullptr) return error("pos needs pos=");
    const auto position = read_hub_position(rules_, *text);
    if (!position) return error(position.error().message);
    Record record(rules_, *position);
    if (const std::string* moves = line.find("moves")) {
      std::size_t at = 0;
      while ((at = moves->find_first_not_of(' ', at)) != std::string::npos) {
        const std::size_t end = std::min(moves->find(' ', at), moves->size());
        const auto move = read_move(rules_, record.position(), moves->substr(at, end - at), MoveStyle::hub);
        if (!move) return error(move.error().message);
        if (record.moves().size() >= most_hub_moves) return error("too many moves");
        record.play(*move);
        at = end;
      }
    }
    record_ = std::move(record);
    has_position_ = true;
  }

  void set_level(const HubLine& line) {
    Level level;
    const auto value = [&](const char* name, double lowest, double highest) -> std::optional<double> {
      const std::string* text = line.find(name);
      return text == nullptr ? std::nullopt : hub_number(*text, lowest, highest);
    };
    if (const auto depth = value("depth", 1, 100)) level.depth = static_cast<int>(*depth);
    if (const auto nodes = value("nodes", 1, 1e18)) level.nodes = static_cast<std::uint64_t>(*nodes);
    if (const auto move_time = value("move-time", 0, 1e6)) {
      level.hard_s = std::max(*move_time - reserve_s, 0.001);
    } else if (const auto time = value("time", -1e6, 1e6)) {
      const double left = std::max(*time, 0.0);
      const double inc = value("inc", 0, 1e6).value_or(0);
      const double moves = value("moves", 1, 1000).value_or(30);
      const double share = left / std::min(moves, 30.0) + 0.8 * inc;
      level.soft_s = std::max(0.6 * share, 0.001);
      level.hard_s = std::max(std::min(2.5 * share, 0.4 * left) - reserve_s, 0.001);
    }
    level_ = level;
  }

  void go(const HubLine& line) {
    if (!has_position_) return error("no legal position has been given");
    if (!has_move(rules_, record_.position())) return error("there is no legal move in this position");
    pondering_ = line.find("ponder") != nullptr;
    stop_ = false;
    started_ = Clock::now();
    searcher();
    if (thread_.joinable()) thread_.join();
    searching_ = true;
    thread_ = std::thread([this] { search(); });
  }

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - started_.load()).count(); }

  void search() {
    SearchReport report;
    std::vector<std::uint64_t> earlier = record_.keys();
    earlier.pop_back();
    const Position& root = record_.position();
    if (level_of_play_ > 0) {
      const Choice choice =
          choose(searcher(), rules_, root, earlier, plan_of_level(level_of_play_), 1, [this] { return over(); });
      report.line = choice.line;
      report.value = choice.best.value;
      inform(report);
    } else {
      SearchLimits limits;
      limits.depth = level_.depth;
      limits.nodes = level_.nodes;
      limits.give_up = [this] { return over(); };
      limits.deep_enough = [this] { return !pondering_ && level_.soft_s > 0 && elapsed() >= level_.soft_s; };
      MoveList legal;
      generate(rules_, root, legal);
      // A forced move needs no more thought than its score.
      if (legal.size() == 1 && !pondering_ && level_.hard_s > 0) limits.depth = std::min(limits.depth, 3);
      report = searcher().search(root, earlier, limits, [this](const SearchReport& r) { inform(r); });
    }
    {
      std::unique_lock lock(mutex_);
      ended_pondering_.wait(lock, [this] { return !pondering_ || stop_; });
    }
    HubLine done{"done", {}};
    done.with("move", hub_text(rules_, report.line.front()));
    if (report.line.size() > 1) done.with("ponder", hub_text(rules_, report.line[1]));
    put(write_hub_line(done));
    searching_ = false;
  }

  bool over() const { return stop_ || (!pondering_ && level_.hard_s > 0 && elapsed() >= level_.hard_s); }

  void inform(const SearchReport& report) {
    std::string line;
    for (const Move& move : report.line) {
      if (!line.empty()) line += ' ';
      line += hub_text(rules_, move);
    }
    const double seconds = elapsed();
    put(write_hub_line(
        HubLine{"info", {}}
            .with("depth", std::to_string(report.depth))
            .with("mean-depth", number(report.mean_depth, "%.1f"))
            .with("score", number(report.value / static_cast<double>(man_value), "%.2f"))
            .with("nodes", std::to_string(report.nodes))
            .with("time", number(seconds, "%.3f"))
            .with("nps", number(static_cast<double>(report.nodes) / std::max(seconds, 1e-6) / 1e6, "%.3f"))
            .with("pv", line)));
  }

  void ponder_hit() {
    const std::lock_guard lock(mutex_);
    started_ = Clock::now();  // his time was free, ours begins
    pondering_ = false;
    ended_pondering_.notify_all();
  }

  void stop_search() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
      ended_pondering_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
    searching_ = false;
  }

  void put(const std::string& line) {
    const std::lock_guard lock(output_);
    out_ << line << std::endl;
  }

  void error(const std::string& message) { put(write_hub_line(HubLine{"error", {}}.with("message", message))); }

  std::istream& in_;
  std::ostream& out_;
  // Reading std::cin flushes what it is tied to, which is std::cout; while the search writes to that, lines went out
  // twice, and the answer to one position was taken for that to the next.
  std::ostream* tied_;
  const EndgameTables* endgames_;
  const Rules& rules_ = international_rules;
  int level_of_play_ = 0;  // 0: full strength within the limits of `level`
  Evaluation evaluation_ = Evaluation::trained;
  int hash_mb_ = 64;
  std::unique_ptr<Searcher> searcher_;
  Record record_;
  bool has_position_ = true;
  Level level_;

  std::thread thread_;
  std::mutex output_;
  std::mutex mutex_;
  std::condition_variable ended_pondering_;
  std::atomic<bool> searching_ = false;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> pondering_ = false;
  std::atomic<Clock::time_point> started_{};
};

}  // namespace

void run_hub_engine(std::istream& in, std::ostream& out, const EndgameTables* endgames) {
  HubEngine(in, out, endgames).run();
}

}  // namespace counterpart
