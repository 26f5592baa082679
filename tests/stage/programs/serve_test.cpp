#include "stage/programs/serve.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

LinkOptions options_for(Role role) {
  LinkOptions options;
  options.role = role;
  options.lockstep = true;
  return options;
}

// A tracker that answers every frame at once; tells what came.
struct Seen {
  std::vector<FrameId> frames;
  int intrinsics = 0;
  bool bye = false;
};

Seen watch(Endpoint& endpoint, std::atomic<bool>& finished, std::uint64_t stop_answering_after = ~0ull) {
  Seen seen;
  for (int empty = 0; empty < 40 && !seen.bye;) {
    const auto inbound = endpoint.receive(50'000'000);
    empty = inbound.empty() && finished ? empty + 10 : inbound.empty() ? empty + 1 : 0;
    for (const Inbound& item : inbound) {
      const auto* received = std::get_if<Received>(&item);
      if (received == nullptr) continue;
      if (std::holds_alternative<Intrinsics>(received->message)) ++seen.intrinsics;
      if (std::holds_alternative<Bye>(received->message)) seen.bye = true;
      if (const auto* video = std::get_if<VideoFrame>(&received->message)) {
        seen.frames.push_back(video->stamp.frame_id);
        EXPECT_EQ(video->bytes.size(), std::size_t{720} * 576 * 3);
        EXPECT_EQ(video->stamp.capture_ns, static_cast<std::int64_t>(video->stamp.frame_id) * 40'000'000);
        if (seen.frames.size() <= stop_answering_after) endpoint.broadcast(FrameDone{video->stamp});
      }
    }
  }
  return seen;
}

Scenario scenario_of_pieces_only() {
  Scenario scenario;
  scenario.player_present = false;
  return scenario;
}

TEST(Serve, LockstepSendsEveryFrameOnceAndSaysGoodbye) {
  auto [camera_end, tracker_end] = memory_link(options_for(Role::camera), options_for(Role::tracker));
  Film film = Film::begin(scenario_of_pieces_only()).value();
  ServeOptions options;
  options.lockstep = true;
  options.frames = 5;
  std::atomic<bool> interrupted{false}, finished{false};
  Seen seen;
  std::thread tracker([&, &end = *tracker_end] { seen = watch(end, finished); });
  const Result<void> served = serve_film(film, *camera_end, options, [&] { return interrupted.load(); });
  finished = true;
  tracker.join();
  EXPECT_TRUE(served.has_value());
  EXPECT_EQ(seen.frames, (std::vector<FrameId>{0, 1, 2, 3, 4}));
  EXPECT_GE(seen.intrinsics, 1);
}

TEST(Serve, LockstepWaitsForFrameDone) {
  auto [camera_end, tracker_end] = memory_link(options_for(Role::camera), options_for(Role::tracker));
  Film film = Film::begin(scenario_of_pieces_only()).value();
  ServeOptions options;
  options.lockstep = true;
  options.frames = 50;
  std::atomic<bool> interrupted{false}, finished{false};
  Seen seen;
  std::thread tracker([&, &end = *tracker_end] {
    seen = watch(end, finished, 2);
    interrupted = true;
  });
  EXPECT_TRUE(serve_film(film, *camera_end, options, [&] { return interrupted.load(); }).has_value());
  finished = true;
  tracker.join();
  EXPECT_EQ(seen.frames, (std::vector<FrameId>{0, 1, 2})) << "the third was never answered";
}

}  // namespace
}  // namespace counterpart::stage
