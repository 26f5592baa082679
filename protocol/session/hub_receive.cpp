#include <algorithm>

#include "protocol/codec/codec.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/session/hub.hpp"

namespace counterpart {
namespace {

// A program that does not read for a while finds the newest pictures, not all of them.
constexpr int kMostPictures = 8;
constexpr int kMostChainedInbound = 64;  // small ones, of which the newest needs those before it

// An acknowledgement of its own would wake the peer for nothing if an answer goes out a moment later.
constexpr std::int64_t kAcknowledgeWithin = 5'000'000;
constexpr std::size_t kMostUnacknowledgedBytes = 128U << 10;

std::size_t weight(const Message& message) {
  const auto* video = std::get_if<VideoFrame>(&message);
  return 512 + (video != nullptr ? video->bytes.size() : 0);
}

}  // namespace

void Hub::read(ConnectionId id, std::size_t count, std::int64_t now_ns) {
  const auto found = connections_.find(id);
  if (found == connections_.end()) return;
  Connection& connection = found->second;
  connection.parser.filled(count);
  connection.last_read_ns = now_ns;
  while (connection.stage != Stage::closing) {
    auto raw = connection.parser.next();
    if (!raw) return fail(id, connection, raw.error(), now_ns);
    if (!*raw) break;
    connection.message_began_ns = -1;
    if (auto done = on_message(id, connection, **raw, now_ns); !done) {
      if (connection.stage != Stage::closing) fail(id, connection, done.error(), now_ns);
      return;
    }
    connection.parser.reuse(std::move((*raw)->body));
  }
  if (!connection.parser.inside_message()) {
    connection.message_began_ns = -1;
  } else if (connection.message_began_ns < 0) {
    connection.message_began_ns = now_ns;
  }
}

void Hub::acknowledge_soon(Connection& connection, std::size_t bytes, std::int64_t now_ns) {
  connection.unacknowledged_bytes += bytes;
  if (connection.acknowledge_by_ns < 0) connection.acknowledge_by_ns = now_ns + kAcknowledgeWithin;
  if (connection.unacknowledged_bytes >= kMostUnacknowledgedBytes) connection.acknowledge_by_ns = now_ns;
}

void Hub::count_work(Connection& connection, MessageType type, std::int64_t now_ns) {
  if (!is_json(type) && type != MessageType::clock_request) return;
  const std::int64_t pause_until_ns = connection.rate.count(now_ns);
  if (pause_until_ns > now_ns) connection.paused_until_ns = pause_until_ns;
}

Result<void> Hub::on_message(ConnectionId id, Connection& connection, RawMessage& raw, std::int64_t now_ns) {
  if (tap_ != nullptr) {
    tap_->saw(true, connection.lane == LaneName::video, connection.peer, raw.header_bytes, raw.body, now_ns);
  }
  Peer* peer = peer_of(connection);
  if (peer != nullptr) {
    ++peer->counts.received;
    peer->counts.bytes_received += kHeaderSize + raw.body.size();
  }
  const bool open = connection.stage == Stage::open && peer != nullptr;
  if (open && (raw.header.flags & kFlagKept) != 0) {
    const auto arrival = lane_of(*peer, connection.lane).arrived(raw.header.seq);
    acknowledge_soon(connection, kHeaderSize + raw.body.size(), now_ns);
    if (arrival == Lane::Arrival::duplicate) return {};
    if (arrival == Lane::Arrival::gap) {
      return failure(ErrorCode::bad_format,
                     "message " + std::to_string(raw.header.seq) + " came where an earlier one was expected");
    }
  }
  if (!is_known(raw.header.type)) {
    if (peer != nullptr) ++peer->counts.skipped;
    return {};
  }
  const auto type = static_cast<MessageType>(raw.header.type);
  count_work(connection, type, now_ns);
  auto message = open ? decode(type, std::move(raw.body)) : decode(type, raw.body);
  if (!message) {
    if (open) end_session(*peer, message.error(), now_ns);
    return tl::make_unexpected(message.error());
  }
  if (!open) return handshake(id, connection, raw, *message, now_ns);
  return on_open_message(id, connection, raw.header, std::move(*message), now_ns);
}

Result<void> Hub::on_open_message(ConnectionId id, Connection& connection, const Header& header, Message&& message,
                                  std::int64_t now_ns) {
  Peer& peer = *peer_of(connection);
  switch (static_cast<MessageType>(header.type)) {
    case MessageType::heartbeat:
      return {};
    case MessageType::acknowledge:
      if (lane_of(peer, connection.lane).acknowledge(std::get<Acknowledge>(message).seq)) return {};
      return failure(ErrorCode::bad_format, "the peer acknowledges a message that was never sent");
    case MessageType::clock_request:
      say(connection, ClockResponse{std::get<ClockRequest>(message).sent_ns, now_ns, now_ns});
      return {};
    case MessageType::clock_response: {
      const auto& clock = std::get<ClockResponse>(message);
      peer.clock.add(clock.sent_ns, clock.received_ns, clock.answered_ns, now_ns);
      return {};
    }
    case MessageType::error: {
      const auto& report = std::get<ErrorReport>(message);
      drop(id, {static_cast<ErrorCode>(report.code), report.message}, now_ns);
      return {};
    }
    case MessageType::bye: {
      const PeerId gone = peer.id;
      const ConnectionId main = peer.main_connection;
      const ConnectionId video = peer.video_connection;
      // It may come on either lane first; the program hears of it once.
      drop(main, {ErrorCode::closed, std::get<Bye>(message).reason}, now_ns, true);
      drop(video, {ErrorCode::closed, "the session is over"}, now_ns);
      forget_peer(gone);
      return {};
    }
    case MessageType::hello:
    case MessageType::welcome:
    case MessageType::challenge:
    case MessageType::proof:
      return failure(ErrorCode::bad_format, "the peer sent a " +
                                                std::string(name_of(static_cast<MessageType>(header.type))) +
                                                " message in an open session");
    default:
      deliver(peer, std::move(message), now_ns);
      return {};
  }
}

void Hub::deliver(Peer& peer, Message&& message, std::int64_t now_ns) {
  const auto* picture = std::get_if<VideoFrame>(&message);
  const int most = picture != nullptr && picture->codec == PixelCodec::h264 ? kMostChainedInbound : kMostPictures;
  if (picture != nullptr && !peer.lockstep && ++peer.pictures_waiting > most) {
    const auto oldest = std::find_if(inbound_.begin(), inbound_.end(), [&](const Inbound& inbound) {
      const auto* received = std::get_if<Received>(&inbound);
      return received != nullptr && received->peer == peer.id && std::holds_alternative<VideoFrame>(received->message);
    });
    if (oldest != inbound_.end()) {
      inbound_bytes_ -= weight(std::get<Received>(*oldest).message);
      inbound_.erase(oldest);
      --peer.pictures_waiting;
      ++peer.counts.dropped;
    }
  }
  inbound_bytes_ += weight(message);
  inbound_.emplace_back(Received{peer.id, std::move(message), now_ns});
}

}  // namespace counterpart
