// One host of two.
//   far_worker tracker LISTEN TOKEN_FILE FRAMES PER_SECOND VIDEO
// sends FRAMES pictures with their poses, then goodbye;
//   far_worker renderer ADDRESS TOKEN_FILE CLOCK_OFFSET_NS
// pairs them and says what it saw as one JSON object.
// VIDEO: raw, tiny pictures; auto, as large as a camera's and as the link chooses; jpeg, so without H.264.
// The number of a frame is written into its picture and into its pose, so that a wrong pairing shows.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/h264/h264.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/jpeg.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "vhd_renderer/pipeline/pairing.hpp"

namespace {

using namespace counterpart;

constexpr std::int64_t kSecond = 1'000'000'000;

std::unique_ptr<Endpoint> open(bool listens, const std::string& address, const std::string& token_file,
                               const std::string& video = "auto") {
  LinkOptions options;
  options.role = listens ? Role::tracker : Role::renderer;
  options.software = "far_worker";
  options.token_file = token_file;
  if (video == "raw") options.video_codec = PixelCodec::raw_bgr8;
  if (video == "auto") use_h264(options);
  auto link = listens ? listen_tcp(address, options) : connect_tcp(address, options);
  if (link) return std::move(*link);
  std::fprintf(stderr, "%s\n", link.error().message.c_str());
  std::exit(1);
}

// The number stands in the first row of squares, a bit each, black or white, so that it outlives compression.
constexpr std::size_t kBits = 16;

VideoFrame empty_picture(std::uint16_t width, std::uint16_t height) {
  VideoFrame out;
  out.width = width;
  out.height = height;
  out.stride = 3U * width;
  out.bytes.resize(std::size_t{out.stride} * height);
  return out;
}

// Noise on shades, about as hard to compress as a camera's picture of a room.
VideoFrame camera_picture(unsigned seed) {
  VideoFrame out = empty_picture(720, 576);
  std::mt19937 random(seed);
  for (std::size_t at = 0; at < out.bytes.size(); ++at) {
    const std::size_t row = at / out.stride, column = at % out.stride;
    out.bytes[at] = static_cast<std::uint8_t>(60 + row / 8 + column / 48 + random() % 24);
  }
  return out;
}

// One after the other, again and again: a camera's noise is another in each picture.
std::vector<VideoFrame> camera_pictures() {
  std::vector<VideoFrame> out;
  for (unsigned seed = 1; seed <= 8; ++seed) out.push_back(camera_picture(seed));
  return out;
}

void write_number(VideoFrame& picture, FrameId frame) {
  picture.stamp = {frame, monotonic_ns()};
  const std::size_t side = picture.width / kBits;
  for (std::size_t bit = 0; bit < kBits; ++bit) {
    for (std::size_t row = 0; row < side; ++row) {
      std::memset(&picture.bytes[row * picture.stride + 3 * bit * side], (frame >> bit & 1) != 0 ? 255 : 0, 3 * side);
    }
  }
}

FrameId number_of(const VideoFrame& picture) {
  const auto raw = convert(picture, PixelCodec::raw_bgr8);
  if (!raw) return 0;
  const std::size_t side = raw->width / kBits;
  FrameId frame = 0;
  for (std::size_t bit = 0; bit < kBits; ++bit) {
    const std::size_t middle = side / 2 * raw->stride + 3 * (bit * side + side / 2);
    frame |= FrameId{raw->bytes[middle] > 127U} << bit;
  }
  return frame;
}

bool is_of(const PairedFrame& pair, FrameId frame) {
  return number_of(pair.video) == frame % (1U << kBits) && pair.pose.X_CB.p[0] == static_cast<double>(frame);
}

// Waits for the renderer, and at the end until everything went out.
int track(Endpoint& link, FrameId frames, double per_second, std::vector<VideoFrame> pictures) {
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
    VideoFrame& picture = pictures[frame % pictures.size()];
    write_number(picture, frame);
    link.broadcast(picture);
    link.broadcast(pose);
  }
  for (int i = 0; i < 20; ++i) static_cast<void>(link.receive(kSecond / 20));
  return 0;
}

// share: 0.5, the median.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return -1;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

int render(Endpoint& link, std::int64_t true_offset_ns) {
  Pairing pairing(PairingPolicy::newest);
  std::uint64_t composited = 0, wrong = 0, pictures = 0, bytes = 0, inside = 0;
  std::vector<double> errors_ms, bounds_ms, delays_ms, seen_at_s;
  std::int64_t next_look = 0;
  for (bool over = false; !over;) {
    for (Inbound& inbound : link.receive(kSecond / 20)) {
      if (const auto* left = std::get_if<PeerLeft>(&inbound)) over |= left->said_goodbye;
      auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;
      if (const auto* pose = std::get_if<PoseEstimate>(&received->message)) pairing.add(*pose);
      if (auto* video = std::get_if<VideoFrame>(&received->message)) {
        ++pictures;
        seen_at_s.push_back(static_cast<double>(received->received_ns) / 1e9);
        delays_ms.push_back(static_cast<double>(received->received_ns + true_offset_ns - video->stamp.capture_ns) /
                            1e6);
        pairing.add(std::move(*video));
      }
      while (const auto pair = pairing.take()) {
        ++composited;
        wrong += is_of(*pair, pair->video.stamp.frame_id) ? 0 : 1;
      }
    }
    const auto stats = link.stats();
    if (!stats.empty()) bytes = stats[0].bytes_received;
    if (monotonic_ns() < next_look || stats.empty() || stats[0].clock_bound_ns < 0) continue;
    next_look = monotonic_ns() + kSecond / 10;
    const std::int64_t error_ns = std::abs(stats[0].clock_offset_ns - true_offset_ns);
    inside += error_ns <= stats[0].clock_bound_ns ? 1 : 0;
    errors_ms.push_back(static_cast<double>(error_ns) / 1e6);
    bounds_ms.push_back(static_cast<double>(stats[0].clock_bound_ns) / 1e6);
  }
  const double worst = errors_ms.empty() ? -1 : *std::max_element(errors_ms.begin(), errors_ms.end());
  const double over_s = pictures > 1 ? seen_at_s.back() - seen_at_s.front() : 1;
  std::cout << nlohmann::json{{"pictures", pictures},
                              {"pictures_per_s", static_cast<double>(pictures) / over_s},
                              {"bytes_a_picture", pictures > 0 ? bytes / pictures : 0},
                              {"delay_ms_median", median(delays_ms)},
                              {"delay_ms_p95", quantile(delays_ms, 0.95)},
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
  if (role == "tracker" && argc == 7) {
    const std::string video = argv[6];
    return track(*open(true, argv[2], argv[3], video), std::strtoull(argv[4], nullptr, 10), std::atof(argv[5]),
                 video == "raw" ? std::vector{empty_picture(16, 12)} : camera_pictures());
  }
  if (role == "renderer" && argc == 5) {
    return render(*open(false, argv[2], argv[3]), std::strtoll(argv[4], nullptr, 10));
  }
  std::fprintf(stderr,
               "usage: far_worker tracker LISTEN TOKEN_FILE FRAMES PER_SECOND raw|jpeg|auto\n"
               "       far_worker renderer ADDRESS TOKEN_FILE CLOCK_OFFSET_NS\n");
  return 2;
}
