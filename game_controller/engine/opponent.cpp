#include "game_controller/engine/opponent.hpp"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "game_controller/engine/level.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr std::size_t table_bytes = std::size_t{32} << 20;
constexpr std::size_t lockstep_table_bytes = std::size_t{4} << 20;  // cleared before each move, so small

class Mind {
 public:
  Mind(const Rules& rules, const OpponentOptions& options)
      : rules_(rules),
        plan_(plan_of_level(options.level)),
        seed_(options.seed),
        lockstep_(options.lockstep),
        searcher_(rules, plan_.evaluation, options.lockstep ? lockstep_table_bytes : table_bytes) {}

  Result<OpponentMove> answer(const std::string& fen, const std::function<bool()>& give_up) {
    const auto position = read_fen(rules_, fen);
    if (!position) return tl::make_unexpected(position.error());
    if (!has_move(rules_, *position)) {
      return failure(ErrorCode::invalid_argument, "There is no legal move in " + fen + ": the game is over.");
    }
    if (lockstep_) searcher_.clear();  // the answer depends on nothing but its arguments
    const Choice choice = choose(searcher_, rules_, *position, {}, plan_, seed_, give_up);
    OpponentMove move;
    move.move = path_text(rules_, *position, choice.best.move);
    move.score = choice.best.value / static_cast<double>(man_value);
    Position at = *position;
    for (const Move& step : choice.line) {
      move.line.push_back(pdn_text(rules_, at, step));
      at = after(rules_, at, step);
    }
    move.acted_thinking_s = acted_thinking_s(rules_, *position);
    return move;
  }

 private:
  const Rules& rules_;
  LevelPlan plan_;
  std::uint64_t seed_;
  bool lockstep_;
  Searcher searcher_;
};

class LockstepOpponent final : public Opponent {
 public:
  LockstepOpponent(const Rules& rules, const OpponentOptions& options) : mind_(rules, options) {}

  void think(const std::string& fen) override { fen_ = fen; }

  std::optional<Result<OpponentMove>> poll() override {
    if (!fen_) return std::nullopt;
    const std::string fen = *std::exchange(fen_, std::nullopt);
    return mind_.answer(fen, {});
  }

 private:
  Mind mind_;
  std::optional<std::string> fen_;
};

// Thinks on a thread of its own, so that the caller's frames go on.
class ThreadedOpponent final : public Opponent {
 public:
  ThreadedOpponent(const Rules& rules, const OpponentOptions& options) : mind_(rules, options) {
    thread_ = std::thread([this] { run(); });
  }

  ~ThreadedOpponent() override {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

  void think(const std::string& fen) override {
    {
      const std::lock_guard lock(mutex_);
      job_ = fen;
      answer_.reset();
      ++wanted_;
      stop_ = true;
    }
    wake_.notify_one();
  }

  std::optional<Result<OpponentMove>> poll() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(answer_, std::nullopt);
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return quit_ || job_.has_value(); });
      if (quit_) return;
      const std::string fen = *std::exchange(job_, std::nullopt);
      const int mine = wanted_;
      stop_ = false;
      lock.unlock();
      auto answer = mind_.answer(fen, [this] { return stop_.load(); });
      lock.lock();
      if (mine == wanted_) answer_ = std::move(answer);  // otherwise it was asked something newer meanwhile
    }
  }

  Mind mind_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::atomic<bool> stop_ = false;
  bool quit_ = false;
  std::optional<std::string> job_;
  std::optional<Result<OpponentMove>> answer_;
  int wanted_ = 0;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<Opponent>> make_opponent(const OpponentOptions& options) {
  const Rules* rules = find_rules(options.rules);
  if (rules == nullptr) {
    return failure(ErrorCode::invalid_argument,
                   "There are no rules named \"" + options.rules + "\"; use international, brazilian or english.");
  }
  if (options.level < lowest_level || options.level > highest_level) {
    return failure(ErrorCode::invalid_argument,
                   "Level " + std::to_string(options.level) + " does not exist; levels go from 1 to 8.");
  }
  if (options.lockstep) return std::make_unique<LockstepOpponent>(*rules, options);
  return std::make_unique<ThreadedOpponent>(*rules, options);
}

}  // namespace counterpart
