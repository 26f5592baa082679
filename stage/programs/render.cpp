#include "stage/programs/render.hpp"

#include <chrono>
#include <cstdio>
#include <future>

#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "stage/film/sequence.hpp"

namespace counterpart::stage {
namespace {

void show_progress(int done, int all) {
  if (isatty(STDERR_FILENO) == 0) return;
  constexpr int kWidth = 40;
  const int filled = done * kWidth / all;
  std::fprintf(stderr, "\r[%s%s] %d/%d", std::string(static_cast<std::size_t>(filled), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(), done, all);
  if (done == all) std::fputc('\n', stderr);
}

}  // namespace

Result<void> run_render(const RenderOptions& options, const std::function<bool()>& stop_requested) {
  Result<Scenario> scenario = load_scenario(options.scenario);
  if (!scenario) return tl::make_unexpected(scenario.error());
  if (options.seed) reseed(*scenario, *options.seed);
  const int frames = options.frames.value_or(scenario->frames);
  Result<Film> film = Film::begin(*scenario);
  if (!film) return tl::make_unexpected(film.error());
  if (!film->warning().empty()) spdlog::warn("{}", film->warning());
  Result<SequenceWriter> writer = SequenceWriter::create(options.out, *scenario);
  if (!writer) return tl::make_unexpected(writer.error());

  using Clock = std::chrono::steady_clock;
  Clock::duration drawing{};
  int done = 0;
  std::future<Result<void>> writing;  // of the picture before: it is compressed while the next one is drawn
  const auto written = [&writing] { return writing.valid() ? writing.get() : Result<void>(); };
  for (int i = 0; i < options.from && !stop_requested(); ++i) film->skip();
  while (done < frames && !stop_requested()) {
    const auto start = Clock::now();
    Shot shot = film->next();
    drawing += Clock::now() - start;
    if (const Result<void> before = written(); !before) return before;
    writing = std::async(std::launch::async, [&writer, shot = std::move(shot)] { return writer->write(shot); });
    if (options.masks) {
      char name[32];
      std::snprintf(name, sizeof name, "/mask_%05d.png", options.from + done);
      if (!cv::imwrite(options.out + name, film->arm_mask())) {
        return failure(ErrorCode::io, "Cannot write " + options.out + name + ".");
      }
    }
    show_progress(++done, frames);
  }
  if (const Result<void> last = written(); !last) return last;
  spdlog::info("{} frames to {}, {:.1f} ms each to draw", done, options.out,
               std::chrono::duration<double, std::milli>(drawing).count() / std::max(1, done));
  return {};
}

}  // namespace counterpart::stage
