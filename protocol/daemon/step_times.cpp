#include "protocol/daemon/step_times.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace counterpart {
namespace {

constexpr std::size_t kKept = 20'000;

float quantile(const std::vector<float>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

void StepTimes::add(const std::string& step, double ms) {
  Series& series = steps_[step];
  if (series.ms.size() < kKept) {
    series.ms.push_back(static_cast<float>(ms));
  } else {
    series.ms[series.count % kKept] = static_cast<float>(ms);
  }
  ++series.count;
}

nlohmann::json StepTimes::report() const {
  nlohmann::json out = nlohmann::json::object();
  for (const auto& [step, series] : steps_) {
    std::vector<float> sorted = series.ms;
    std::sort(sorted.begin(), sorted.end());
    out[step] = {{"median", quantile(sorted, 0.5)},
                 {"p95", quantile(sorted, 0.95)},
                 {"max", sorted.back()},
                 {"count", series.count}};
  }
  return out;
}

}  // namespace counterpart
