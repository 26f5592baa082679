#include "stage/programs/serve.hpp"

#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "protocol/h264/h264.hpp"
#include "stage/film/sequence.hpp"

namespace counterpart::stage {
namespace {

using Clock = std::chrono::steady_clock;

Message video_message(const Shot& shot) {
  VideoFrame video;
  video.stamp = shot.truth.stamp;
  video.codec = PixelCodec::raw_bgr8;
  video.width = static_cast<std::uint16_t>(shot.image_bgr.cols);
  video.height = static_cast<std::uint16_t>(shot.image_bgr.rows);
  video.stride = static_cast<std::uint32_t>(shot.image_bgr.cols * 3);
  video.bytes.assign(shot.image_bgr.data, shot.image_bgr.data + shot.image_bgr.total() * 3);
  return video;
}

// One run: what was sent last, and who is there to see it.
class Broadcast {
 public:
  Broadcast(Film& film, Endpoint& endpoint, const ServeOptions& options)
      : film_(film), endpoint_(endpoint), options_(options) {}

  Result<void> open_truth() {
    if (options_.truth.empty()) return {};
    truth_.open(options_.truth);
    if (truth_) return {};
    return failure(ErrorCode::io, "Cannot write " + options_.truth + "; does its folder exist?");
  }

  void listen(std::int64_t timeout_ns) {
    for (const Inbound& inbound : endpoint_.receive(timeout_ns)) {
      if (const auto* joined = std::get_if<PeerJoined>(&inbound)) {
        on_joined(*joined);
      } else if (const auto* left = std::get_if<PeerLeft>(&inbound)) {
        peers_.erase(left->peer);
        spdlog::info("a peer left: {}", left->reason.message);
      } else if (const auto* received = std::get_if<Received>(&inbound)) {
        on_message(received->message);
      }
    }
  }

  bool watched() const { return !peers_.empty(); }
  bool last_is_done() const { return last_done_; }
  std::uint64_t sent() const { return sent_; }

  Result<void> send_next() {
    shot_ = film_.next();
    last_done_ = false;
    ++sent_;
    if (!options_.truth.empty() && !(truth_ << truth_line(shot_.truth) << std::endl)) {
      return failure(ErrorCode::io, "Cannot write to " + options_.truth + "; is the disk full?");
    }
    if (!(shot_.truth.view.intrinsics == intrinsics_)) {
      intrinsics_ = shot_.truth.view.intrinsics;
      endpoint_.broadcast(intrinsics_);
    }
    endpoint_.broadcast(video_message(shot_));
    return {};
  }

 private:
  void on_joined(const PeerJoined& joined) {
    peers_.insert(joined.peer);
    spdlog::info("{} joined{}", joined.software.empty() ? "a peer" : joined.software, joined.resumed ? " again" : "");
    if (joined.resumed) return;  // the link sends again what was lost
    intrinsics_ = film_.scenario().intrinsics;
    if (sent_ > 0) intrinsics_ = shot_.truth.view.intrinsics;
    endpoint_.send(joined.peer, intrinsics_);
    if (sent_ > 0) endpoint_.send(joined.peer, video_message(shot_));
  }

  void on_message(const Message& message) {
    if (const auto* done = std::get_if<FrameDone>(&message)) {
      if (sent_ > 0 && done->stamp.frame_id == shot_.truth.stamp.frame_id) last_done_ = true;
    } else if (const auto* state = std::get_if<BoardState>(&message)) {
      film_.show(*state);
    }
  }

  Film& film_;
  Endpoint& endpoint_;
  const ServeOptions& options_;
  std::ofstream truth_;
  Intrinsics intrinsics_;
  Shot shot_;
  std::set<PeerId> peers_;  // those who are connected
  bool last_done_ = true;
  std::uint64_t sent_ = 0;
};

}  // namespace

Result<void> serve_film(Film& film, Endpoint& endpoint, const ServeOptions& options,
                        const std::function<bool()>& stop_requested) {
  constexpr std::int64_t kListen_ns = 20'000'000;
  Broadcast broadcast(film, endpoint, options);
  if (const Result<void> opened = broadcast.open_truth(); !opened) return opened;
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / film.scenario().fps));
  auto due = Clock::now();
  while (!stop_requested() && !(options.frames > 0 && broadcast.sent() >= options.frames &&
                                (broadcast.last_is_done() || !options.lockstep))) {
    // Nobody watches: the room holds its breath, so that nobody misses a move.
    const bool ready = broadcast.watched() && (options.lockstep ? broadcast.last_is_done() : Clock::now() >= due);
    if (!ready) {
      const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(due - Clock::now()).count();
      const bool clocked = broadcast.watched() && !options.lockstep;
      broadcast.listen(clocked ? std::clamp<std::int64_t>(left, 0, kListen_ns) : kListen_ns);
      continue;
    }
    broadcast.listen(0);
    if (!options.lockstep) {
      due += period;
      if (due < Clock::now()) due = Clock::now();  // drawing is slower than the clock: later, not in bursts
    }
    if (const Result<void> sent = broadcast.send_next(); !sent) return sent;
  }
  spdlog::info("{} frames sent", broadcast.sent());
  endpoint.broadcast(Bye{stop_requested() ? "stopped" : "the film has ended"});
  // The last words go out in the background.
  broadcast.listen(200'000'000);
  return {};
}

Result<void> run_serve(const ServeOptions& options, const std::function<bool()>& stop_requested) {
  Scenario scenario;
  if (!options.scenario.empty()) {
    Result<Scenario> loaded = load_scenario(options.scenario);
    if (!loaded) return tl::make_unexpected(loaded.error());
    scenario = *loaded;
  }
  reseed(scenario, options.seed.value_or(scenario.seed));
  Result<Film> film = Film::begin(scenario);
  if (!film) return tl::make_unexpected(film.error());
  if (!film->warning().empty()) spdlog::warn("{}", film->warning());
  LinkOptions link;
  link.role = Role::camera;
  link.software = std::string("stage ") + COUNTERPART_VERSION;
  link.lockstep = options.lockstep;
  link.token_file = options.token_file;
  link.tls_file = options.tls_file;
  use_h264(link);
  Result<std::unique_ptr<Endpoint>> endpoint = listen_tcp(options.listen, link);
  if (!endpoint) return tl::make_unexpected(endpoint.error());
  spdlog::info("a camera at vhp://{}", (*endpoint)->address());
  return serve_film(*film, **endpoint, options, stop_requested);
}

}  // namespace counterpart::stage
