// One host of two.
//   far_worker tracker LISTEN TOKEN_FILE FRAMES PER_SECOND      sends FRAMES pictures with their poses, then goodbye
//   far_worker renderer ADDRESS TOKEN_FILE CLOCK_OFFSET_NS      pairs them; says what it saw as one JSON object
// The number of a frame is written into its picture and into its pose, so that a wrong pairing shows.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "vhd_renderer/pipeline/pairing.hpp"

namespace {

using namespace counterpart;

constexpr std::int64_t kSecond = 1'000'000'000;

std::unique_ptr<Endpoint> open(bool listens, const std::string& address, const std::string& token_file) {
  LinkOptions options;
  options.role = listens ? Role::tracker : Role::renderer;
  options.software = "far_worker";
  options.token_file = token_file;
  options.video_codec = PixelCodec::raw_bgr8;  // the numbers in the pictures must arrive as they were
  auto link = listens ? listen_tcp(address, options) : connect_tcp(address, options);
  if (link) return std::move(*link);
  std::fprintf(stderr, "%s\n", link.error().message.c_str());
  std::exit(1);
}

VideoFrame picture(FrameId frame) {
  VideoFrame out;
  out.stamp = {frame, monotonic_ns()};
  out.width = 16;
  out.height = 12;
  out.stride = 48;
  out.bytes.resize(std::size_t{48} * 12);
  for (std::size_t at = 0; at < out.bytes.size(); at += sizeof frame) std::memcpy(&out.bytes[at], &frame, sizeof frame);
  return out;
}

bool is_of(const PairedFrame& pair, FrameId frame) {
  return pair.video.bytes == picture(frame).bytes && pair.pose.X_CB.p[0] == static_cast<double>(frame);
}

// Waits for the renderer, and at the end until everything went out.
int track(Endpoint& link, FrameId frames, double per_second) {
  bool joined = false;
  while (!joined) {
    for (const Inbound& inbound : link.receive(kSecond)) joined |= std::holds_alternative<PeerJoined>(inbound);
  }
  const std::int64_t start = monotonic_ns() + kSecond / 2;  // the video lane opens
  for (FrameId frame = 1; frame <= frames; ++frame) {
    const std::int64_t due = start + static_cast<std::int64_t>(static_cast<double>(frame) / per_second * 1e9);
    while (monotonic_ns() < due) static_cast<void>(link.receive(due - monotonic_ns()));
    PoseEstimate pose;
    pose.stamp = {frame, monotonic_ns()};
    pose.status = TrackStatus::ok;
    pose.X_CB.p[0] = static_cast<double>(frame);
    link.broadcast(picture(frame));
    link.broadcast(pose);
  }
  for (int i = 0; i < 20; ++i) static_cast<void>(link.receive(kSecond / 20));
  return 0;
}

double median(std::vector<double> values) {
  if (values.empty()) return -1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

int render(Endpoint& link, std::int64_t true_offset_ns) {
  Pairing pairing(PairingPolicy::newest);
  std::uint64_t composited = 0, wrong = 0, pictures = 0, inside = 0;
  std::vector<double> errors_ms, bounds_ms;
  std::int64_t next_look = 0;
  for (bool over = false; !over;) {
    for (Inbound& inbound : link.receive(kSecond / 20)) {
      if (const auto* left = std::get_if<PeerLeft>(&inbound)) over |= left->said_goodbye;
      auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;
      if (const auto* pose = std::get_if<PoseEstimate>(&received->message)) pairing.add(*pose);
      if (auto* video = std::get_if<VideoFrame>(&received->message)) {
        ++pictures;
        pairing.add(std::move(*video));
      }
      while (const auto pair = pairing.take()) {
        ++composited;
        wrong += is_of(*pair, pair->video.stamp.frame_id) ? 0 : 1;
      }
    }
    const auto stats = link.stats();
    if (monotonic_ns() < next_look || stats.empty() || stats[0].clock_bound_ns < 0) continue;
    next_look = monotonic_ns() + kSecond / 10;
    const std::int64_t error_ns = std::abs(stats[0].clock_offset_ns - true_offset_ns);
    inside += error_ns <= stats[0].clock_bound_ns ? 1 : 0;
    errors_ms.push_back(static_cast<double>(error_ns) / 1e6);
    bounds_ms.push_back(static_cast<double>(stats[0].clock_bound_ns) / 1e6);
  }
  const double worst = errors_ms.empty() ? -1 : *std::max_element(errors_ms.begin(), errors_ms.end());
  std::cout << nlohmann::json{{"pictures", pictures},
                              {"composited", composited},
                              {"wrong", wrong},
                              {"clock_looks", errors_ms.size()},
                              {"clock_inside_bound", inside},
                              {"clock_error_ms_median", median(errors_ms)},
                              {"clock_error_ms_worst", worst},
                              {"clock_bound_ms_median", median(bounds_ms)}}
            << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string role = argc > 4 ? argv[1] : "";
  if (role == "tracker" && argc == 6) {
    return track(*open(true, argv[2], argv[3]), std::strtoull(argv[4], nullptr, 10), std::atof(argv[5]));
  }
  if (role == "renderer" && argc == 5) {
    return render(*open(false, argv[2], argv[3]), std::strtoll(argv[4], nullptr, 10));
  }
  std::fprintf(stderr,
               "usage: far_worker tracker LISTEN TOKEN_FILE FRAMES PER_SECOND\n"
               "       far_worker renderer ADDRESS TOKEN_FILE CLOCK_OFFSET_NS\n");
  return 2;
}
