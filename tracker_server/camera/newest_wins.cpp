#include "tracker_server/camera/newest_wins.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace counterpart {
namespace {

class NewestWins : public Camera {
 public:
  explicit NewestWins(std::unique_ptr<Camera> source) : source_(std::move(source)), intrinsics_(source_->intrinsics()) {
    reader_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
  }

  Result<std::optional<Frame>> next() override {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [this] { return waiting_ || end_; });
    if (waiting_) {
      std::optional<Frame> frame = std::move(waiting_);
      waiting_.reset();
      return frame;
    }
    return *end_;
  }

  std::optional<Intrinsics> intrinsics() const override { return intrinsics_; }

  std::uint64_t dropped() const override {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  void read(const std::stop_token& stop) {
    const auto start = std::chrono::steady_clock::now();
    std::optional<std::int64_t> first_ns;
    while (!stop.stop_requested()) {
      auto frame = source_->next();
      if (frame && *frame) {
        if (!first_ns) first_ns = (*frame)->stamp.capture_ns;
        const auto due = start + std::chrono::nanoseconds((*frame)->stamp.capture_ns - *first_ns);
        std::unique_lock lock(mutex_);
        if (stopped_.wait_until(lock, stop, due, [&stop] { return stop.stop_requested(); })) return;
        if (waiting_) ++dropped_;
        waiting_ = std::move(*frame);
      } else {
        const std::lock_guard lock(mutex_);
        end_ = std::move(frame);
      }
      arrived_.notify_one();
      if (end_) return;
    }
  }

  std::unique_ptr<Camera> source_;
  std::optional<Intrinsics> intrinsics_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::condition_variable_any stopped_;
  std::optional<Frame> waiting_;
  std::optional<Result<std::optional<Frame>>> end_;
  std::uint64_t dropped_ = 0;
  std::jthread reader_;  // last: it is stopped before what it uses goes away
};

}  // namespace

std::unique_ptr<Camera> newest_wins(std::unique_ptr<Camera> source) {
  return std::make_unique<NewestWins>(std::move(source));
}

}  // namespace counterpart
