#include "game_controller/engine/opponent.hpp"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "game_controller/engine/level.hpp"
#include "game_controller/engine/mind.hpp"

namespace counterpart {
namespace {

class LockstepOpponent final : public Opponent {
 public:
  explicit LockstepOpponent(std::unique_ptr<Mind> mind) : mind_(std::move(mind)) {}

  void think(const std::string& fen) override { fen_ = fen; }

  std::optional<Result<OpponentMove>> poll() override {
    if (!fen_) return std::nullopt;
    const std::string fen = *std::exchange(fen_, std::nullopt);
    return mind_->answer(fen, {});
  }

 private:
  std::unique_ptr<Mind> mind_;
  std::optional<std::string> fen_;
};

// Thinks on a thread of its own, so that the caller's frames go on.
class ThreadedOpponent final : public Opponent {
 public:
  explicit ThreadedOpponent(std::unique_ptr<Mind> mind) : mind_(std::move(mind)) {
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
      auto answer = mind_->answer(fen, [this] { return stop_.load(); });
      lock.lock();
      if (mine != wanted_) continue;  // it was asked something newer meanwhile
      answer_ = std::move(answer);
      lock.unlock();
      mind_->ponder([this] { return stop_.load(); });
      lock.lock();
    }
  }

  std::unique_ptr<Mind> mind_;
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
  auto mind = make_mind(*rules, options);
  if (!mind) return tl::make_unexpected(mind.error());
  if (options.lockstep) return std::make_unique<LockstepOpponent>(std::move(*mind));
  return std::make_unique<ThreadedOpponent>(std::move(*mind));
}

}  // namespace counterpart
