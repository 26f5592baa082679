// How long each step of a pipeline took, by the step's name.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace counterpart {

class StepTimes {
 public:
  void add(const std::string& step, double ms);

  // {"pose": {"median": 1.2, "p95": 2.0, "max": 9.1, "count": 4000}, ...} in milliseconds, over the newest 20,000
  // frames.
  nlohmann::json report() const;

 private:
  struct Series {
    std::vector<float> ms;  // a ring once it is full
    std::size_t count = 0;
  };
  std::map<std::string, Series> steps_;
};

// Adds the time from its making to its end to one step.
class StepTimer {
 public:
  StepTimer(StepTimes& times, std::string step)
      : times_(times), step_(std::move(step)), start_(std::chrono::steady_clock::now()) {}
  StepTimer(const StepTimer&) = delete;
  StepTimer& operator=(const StepTimer&) = delete;
  ~StepTimer() {
    times_.add(step_, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
  }

 private:
  StepTimes& times_;
  std::string step_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace counterpart
