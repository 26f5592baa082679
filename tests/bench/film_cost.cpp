// What a frame of the stage costs: CPU milliseconds over all threads, for a scenario: the median frame, the slowest of
// ten, and of that the steps after drawing.
//   film_cost SCENARIO [FRAMES]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <sys/resource.h>

#include "protocol/daemon/picture_memory.hpp"
#include "stage/camera/sensor.hpp"
#include "stage/film/film.hpp"
#include "stage/film/hidden.hpp"

namespace {

double cpu_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace counterpart::stage;
  setenv("LP_NUM_THREADS", "0", 0);  // as `stage` does
  counterpart::keep_picture_memory();
  const int frames = argc > 2 ? std::atoi(argv[2]) : 60;
  if (argc < 2 || frames < 1) {
    std::fprintf(stderr, "usage: film_cost SCENARIO [FRAMES]\n");
    return 2;
  }
  const auto scenario = load_scenario(argv[1]);
  if (!scenario) {
    std::fprintf(stderr, "%s\n", scenario.error().message.c_str());
    return 1;
  }
  auto film = Film::begin(*scenario);
  if (!film) {
    std::fprintf(stderr, "%s\n", film.error().message.c_str());
    return 1;
  }
  film->next();  // compiles what is compiled late
  Shot shot;
  std::vector<double> costs;
  for (int i = 0; i < frames; ++i) {
    const double start = cpu_ms();
    shot = film->next();
    costs.push_back(cpu_ms() - start);
  }
  std::sort(costs.begin(), costs.end());
  const double median = costs[costs.size() / 2];
  const double slow = costs[costs.size() * 9 / 10];

  cv::Mat picture = shot.image_bgr.clone();
  const double before_sensor = cpu_ms();
  for (int i = 0; i < frames; ++i) expose(picture, scenario->sensor, 1, static_cast<std::uint64_t>(i));
  const double sensor = (cpu_ms() - before_sensor) / frames;
  const double before_hidden = cpu_ms();
  for (int i = 0; i < frames; ++i) hidden_shares(film->world(), shot.truth.view);
  const double hidden = (cpu_ms() - before_hidden) / frames;
  std::printf("%s: median %.1f, 90th of 100 %.1f ms of CPU a frame; of that sensor %.1f, truth's shares %.1f\n",
              scenario->name.c_str(), median, slow, sensor, hidden);
  return 0;
}
