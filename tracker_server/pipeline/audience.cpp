#include "tracker_server/pipeline/audience.hpp"

#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace counterpart {
namespace {

// Commands of directors are renumbered from here on; the game counts from 1.
constexpr std::uint64_t kFirstRelayedId = std::uint64_t{1} << 48;

}  // namespace

Audience::Audience(std::unique_ptr<Endpoint> link) : link_(std::move(link)), relay_(kFirstRelayedId) {}

Audience::~Audience() = default;

void Audience::hear(std::int64_t timeout_ns) {
  for (const Inbound& inbound : link_->receive(timeout_ns)) {
    if (const auto* joined = std::get_if<PeerJoined>(&inbound)) join(*joined);
    if (const auto* left = std::get_if<PeerLeft>(&inbound)) leave(*left);
    if (const auto* received = std::get_if<Received>(&inbound)) receive(received->peer, received->message);
  }
}

Heard Audience::take_heard() {
  return std::exchange(heard_, {});
}

void Audience::join(const PeerJoined& joined) {
  spdlog::info("{} joined{}", joined.software, joined.resumed ? " again" : "");
  peers_[joined.peer] = joined.role;
  if (joined.role == Role::renderer && !primary_) {
    primary_ = joined.peer;
    composited_.reset();
    heard_.renderer_joined = !joined.resumed;
  }
  if (joined.resumed) return;  // what it missed is sent again by the link
  for (const auto& [type, snapshot] : snapshots_) link_->send(joined.peer, snapshot);
}

void Audience::leave(const PeerLeft& left) {
  spdlog::warn("peer {} left: {}", left.peer, left.reason.message);
  peers_.erase(left.peer);
  if (primary_ != left.peer) return;
  primary_.reset();
  for (const auto& [peer, role] : peers_) {
    if (role != Role::renderer) continue;
    primary_ = peer;  // the next one answers from now on
    heard_.renderer_joined = true;
    break;
  }
}

void Audience::receive(PeerId peer, const Message& message) {
  if (const auto* feedback = std::get_if<Feedback>(&message)) {
    if (peer != primary_) return;
    if (relay_.owns(feedback->command_id)) {
      relay_feedback(*feedback);
    } else {
      heard_.feedback.push_back(*feedback);
    }
  } else if (const auto* control = std::get_if<Control>(&message)) {
    heard_.controls.push_back(*control);
  } else if (const auto* command = std::get_if<Command>(&message)) {
    relay_order(peer, *command);
  } else if (const auto* done = std::get_if<FrameDone>(&message)) {
    if (peer == primary_) composited_ = done->stamp.frame_id;
  }
}

void Audience::relay_order(PeerId director, const Command& command) {
  if (!primary_) {
    Feedback refused;
    refused.command_id = command.id;
    refused.state = FeedbackState::failed;
    refused.code = "no_renderer";
    link_->send(director, refused);
    return;
  }
  order(relay_.forward(director, command));
}

void Audience::relay_feedback(const Feedback& feedback) {
  const auto answer = relay_.answer(feedback);
  if (answer && peers_.count(answer->director) != 0) link_->send(answer->director, answer->feedback);
}

void Audience::broadcast(const Message& message) {
  link_->broadcast(message);
}

void Audience::show_snapshot(const Message& message) {
  const MessageType type = type_of(message);
  const auto found = snapshots_.find(type);
  if (found != snapshots_.end() && found->second == message) return;
  snapshots_.insert_or_assign(type, message);
  link_->broadcast(message);
}

void Audience::order(const Command& command) {
  for (const auto& [peer, role] : peers_) {
    if (role == Role::renderer || role == Role::observer) link_->send(peer, command);
  }
}

void Audience::show(const Frame& frame) {
  VideoFrame video;
  video.stamp = frame.stamp;
  video.codec = PixelCodec::raw_bgr8;
  video.width = static_cast<std::uint16_t>(frame.image_bgr.cols);
  video.height = static_cast<std::uint16_t>(frame.image_bgr.rows);
  video.stride = static_cast<std::uint32_t>(frame.image_bgr.cols) * 3;
  video.bytes.resize(std::size_t{video.stride} * video.height);
  frame.image_bgr.copyTo(cv::Mat(frame.image_bgr.rows, frame.image_bgr.cols, CV_8UC3, video.bytes.data()));
  link_->broadcast(video);
}

// A socket that is closed while the peer still talks loses the last words; so listen until they have hung up.
void Audience::say_goodbye(const std::string& reason) {
  constexpr std::int64_t kStepNs = 20'000'000;
  constexpr int kSteps = 50;
  link_->broadcast(Bye{reason});
  for (int i = 0; i < kSteps && !peers_.empty(); ++i) hear(kStepNs);
}

std::string Audience::address() const {
  return link_->address();
}

nlohmann::json Audience::report() const {
  nlohmann::json out = nlohmann::json::array();
  for (const PeerStats& peer : link_->stats()) {
    out.push_back({{"peer", peer.peer},
                   {"sent", peer.sent},
                   {"received", peer.received},
                   {"dropped", peer.dropped},
                   {"skipped", peer.skipped}});
  }
  return out;
}

}  // namespace counterpart
