#include "protocol/session/hub.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "protocol/codec/codec.hpp"

namespace counterpart {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kHandshakeLimit = 3 * kSecond;   // of a server, for whoever comes
constexpr std::int64_t kDialLimit = 3 * kSecond;        // of a client: for the connection
constexpr std::int64_t kAnswerLimit = 4 * kSecond / 5;  // and for the answer to HELLO
constexpr std::int64_t kQuickLimit = 2 * kSecond / 5;   // of a client that knows how near the peer is: for either
constexpr std::int64_t kMessageLimit = 10 * kSecond;
constexpr std::int64_t kClosingLimit = kSecond;
constexpr std::int64_t kSessionLimit = 60 * kSecond;
constexpr std::int64_t kFirstWait = kSecond / 20;
constexpr std::int64_t kLongestWait = kSecond / 2;
constexpr std::int64_t kClockBurst = 8;
constexpr std::size_t kMostConnections = 64;
constexpr std::size_t kMostAway = 64;
constexpr std::size_t kMostUrgent = 256;
constexpr std::size_t kMostInbound = 16384;
constexpr std::size_t kLikelyInbound = 256;
constexpr std::size_t kMostInboundBytes = 64U << 20;

}  // namespace

Hub::Hub(End end, LinkOptions options, std::string token, WireTap* tap)
    : end_(end), options_(std::move(options)), token_(std::move(token)), tap_(tap) {}

// --- connections -------------------------------------------------------------------------------------------------

ConnectionId Hub::add_connection(std::int64_t now_ns) {
  const ConnectionId id = ++last_connection_;
  Connection& connection = connections_[id];
  connection.opened_ns = now_ns;
  connection.last_read_ns = now_ns;
  ++changes_;
  return id;
}

std::optional<ConnectionId> Hub::accepted(std::int64_t now_ns) {
  if (connections_.size() >= kMostConnections) return std::nullopt;
  return add_connection(now_ns);
}

WireMessage Hub::refusal(std::int64_t now_ns) const {
  const auto body = encode(ErrorReport{static_cast<std::uint16_t>(ErrorCode::unavailable),
                                       "there are already " + std::to_string(kMostConnections) + " connections"});
  WireMessage message;
  message.body = std::make_shared<const Bytes>(*body);
  Header header;
  header.type = static_cast<std::uint16_t>(MessageType::error);
  header.time_ns = now_ns;
  message.header = seal(header, *message.body);
  return message;
}

std::optional<Hub::LaneName> Hub::wants_to_dial(std::int64_t now_ns) {
  if (end_ != End::client) return std::nullopt;
  if (!main_dial_.busy && main_dial_.next_ns <= now_ns) {
    begin_dial(main_dial_, now_ns);
    return LaneName::main;
  }
  const auto peer = peers_.find(server_peer_);
  const bool open = peer != peers_.end() && peer->second.main_connection != 0;
  if (open && options_.want_video && !video_dial_.busy && video_dial_.next_ns <= now_ns) {
    begin_dial(video_dial_, now_ns);
    return LaneName::video;
  }
  return std::nullopt;
}

ConnectionId Hub::dialled(LaneName lane, std::int64_t now_ns) {
  const ConnectionId id = add_connection(now_ns);
  Connection& connection = connections_.at(id);
  connection.lane = lane;
  begin_hello(id, connection, now_ns);
  return id;
}

void Hub::dial_failed(LaneName lane, const Error& why, std::int64_t now_ns) {
  try_again_later(lane == LaneName::main ? main_dial_ : video_dial_, now_ns);
  if (lane == LaneName::main) note_refusal(why);
}

void Hub::begin_dial(Dial& dial, std::int64_t now_ns) {
  dial.busy = true;
  dial.began_ns = now_ns;
}

// Waits count from the beginning of the last attempt: what an attempt takes is not waited for a second time.
void Hub::try_again_later(Dial& dial, std::int64_t now_ns) {
  dial.busy = false;
  dial.wait_ns = std::clamp(dial.wait_ns * 8 / 5, kFirstWait, kLongestWait);
  dial.next_ns = std::max(now_ns, dial.began_ns + dial.wait_ns);
}

// A peer that was there a moment ago is as near as it was: an attempt that takes much longer fell into the gap, and the
// next one is quicker than TCP's own second try.
std::optional<std::int64_t> Hub::quick_limit(std::int64_t now_ns) const {
  const auto found = peers_.find(server_peer_);
  if (found == peers_.end()) return std::nullopt;
  const Peer& peer = found->second;
  const std::int64_t round_trip_ns = peer.clock.at(now_ns).round_trip_ns;
  const bool long_gone = peer.main_connection == 0 && now_ns - peer.away_since_ns > kSessionLimit;
  if (round_trip_ns < 0 || long_gone) return std::nullopt;
  return kQuickLimit + 4 * round_trip_ns;
}

std::int64_t Hub::dial_limit(std::int64_t now_ns) const {
  return std::min(kDialLimit, quick_limit(now_ns).value_or(kDialLimit));
}

void Hub::note_refusal(const Error& why) {
  last_refusal_ = why;
  if (why.message == last_reported_refusal_) return;
  last_reported_refusal_ = why.message;
  inbound_.push_back(PeerLeft{0, why, false});
}

FrameParser& Hub::parser(ConnectionId connection) {
  return connections_.at(connection).parser;
}

std::vector<ConnectionId> Hub::connections() const {
  std::vector<ConnectionId> ids;
  for (const auto& [id, connection] : connections_) ids.push_back(id);
  return ids;
}

Hub::Peer* Hub::peer_of(const Connection& connection) {
  const auto peer = peers_.find(connection.peer);
  return peer == peers_.end() ? nullptr : &peer->second;
}

void Hub::say(Connection& connection, const Message& message) {
  if (connection.urgent.size() >= kMostUrgent) return;  // a peer that asks and never reads gets no answers
  const auto body = encode(message);
  if (!body) return;  // only messages made here come this way, and those are well-formed
  Outgoing outgoing;
  outgoing.type = type_of(message);
  outgoing.body = std::make_shared<const Bytes>(*body);
  connection.urgent.push_back(std::move(outgoing));
}

void Hub::fail(ConnectionId id, Connection& connection, const Error& error, std::int64_t now_ns) {
  if (connection.stage == Stage::closing) return;
  ++changes_;
  connection.urgent.clear();
  say(connection, ErrorReport{static_cast<std::uint16_t>(error.code), error.message.substr(0, 1000)});
  detach(id, connection, error, now_ns);
  connection.stage = Stage::closing;
  connection.closing_since_ns = now_ns;
}

// The connection no longer carries its session; the session waits for another one.
void Hub::detach(ConnectionId id, Connection& connection, const Error& why, std::int64_t now_ns, bool said_goodbye) {
  const bool was_open = connection.stage == Stage::open;
  if (connection.stage == Stage::closing) return;
  Peer* peer = peer_of(connection);
  connection.peer = 0;
  const bool main = connection.lane == LaneName::main;
  if (end_ == End::client) {
    Dial& dial = main ? main_dial_ : video_dial_;
    if (was_open) dial.began_ns = now_ns;  // a session ended, not an attempt: whoever says goodbye is not back at once
    try_again_later(dial, now_ns);
    if (main && !was_open) note_refusal(why);
  }
  if (peer == nullptr) return;
  ConnectionId& slot = main ? peer->main_connection : peer->video_connection;
  if (slot != id) return;
  slot = 0;
  if (!main) return;
  peer->away_since_ns = now_ns;
  inbound_.push_back(PeerLeft{peer->id, why, said_goodbye});
  if (peer->video_connection != 0) drop(peer->video_connection, why, now_ns);
}

// Ends a connection without a word.
void Hub::drop(ConnectionId id, const Error& why, std::int64_t now_ns, bool said_goodbye) {
  const auto found = connections_.find(id);
  if (found == connections_.end()) return;
  ++changes_;
  detach(id, found->second, why, now_ns, said_goodbye);
  found->second.stage = Stage::closing;
  found->second.urgent.clear();
  found->second.closing_since_ns = now_ns;
}

void Hub::closed(ConnectionId id, Error why, std::int64_t now_ns) {
  const auto found = connections_.find(id);
  if (found == connections_.end()) return;
  ++changes_;
  if (found->second.stage == Stage::waiting_for_welcome && why.code == ErrorCode::closed) {
    why.message += " before it had opened a session; if it asks for TLS, both sides need a --tls-file";
  }
  detach(id, found->second, why, now_ns);
  connections_.erase(found);
}

void Hub::forget_peer(PeerId id) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  sessions_.erase(found->second.session);
  if (server_peer_ == id) server_peer_ = 0;
  peers_.erase(found);
}

// The session is over and will not be resumed.
void Hub::end_session(Peer& peer, const Error& why, std::int64_t now_ns) {
  ++changes_;
  const PeerId id = peer.id;
  const ConnectionId main = peer.main_connection;
  const ConnectionId video = peer.video_connection;
  if (const auto found = connections_.find(main); found != connections_.end()) {
    fail(main, found->second, why, now_ns);
  } else {
    inbound_.push_back(PeerLeft{id, why, false});
  }
  drop(video, why, now_ns);
  forget_peer(id);
}

// --- writing -----------------------------------------------------------------------------------------------------

std::optional<WireMessage> Hub::next_to_write(ConnectionId id, std::int64_t now_ns) {
  const auto found = connections_.find(id);
  if (found == connections_.end()) return std::nullopt;
  Connection& connection = found->second;
  Peer* peer = peer_of(connection);
  const Outgoing* next = nullptr;
  Outgoing urgent;
  if (!connection.urgent.empty()) {
    urgent = std::move(connection.urgent.front());
    connection.urgent.pop_front();
    next = &urgent;
  } else if (connection.stage == Stage::open && peer != nullptr) {
    Lane& lane = lane_of(*peer, connection.lane);
    const std::int64_t by_ns = connection.acknowledge_by_ns;
    if (by_ns >= 0 && (now_ns >= by_ns || lane.has_waiting())) {
      connection.acknowledge_by_ns = -1;
      connection.unacknowledged_bytes = 0;
      say(connection, Acknowledge{lane.last_received()});
      return next_to_write(id, now_ns);
    }
    next = lane.take();
  }
  if (next == nullptr) return std::nullopt;
  Header header;
  header.type = static_cast<std::uint16_t>(next->type);
  header.type_version = kTypeVersion;
  header.flags = next->seq != 0 ? kFlagKept : 0;
  header.session = peer != nullptr ? peer->session : 0;
  header.seq = next->seq;
  header.frame_id = next->frame_id;
  header.time_ns = now_ns;
  WireMessage message{seal(header, *next->body), next->body};
  if (peer != nullptr) {
    ++peer->counts.sent;
    peer->counts.bytes_sent += kHeaderSize + message.body->size();
  }
  if (tap_ != nullptr) {
    tap_->saw(false, connection.lane == LaneName::video, connection.peer, message.header, *message.body, now_ns);
  }
  return message;
}

bool Hub::finished(ConnectionId id) const {
  const auto found = connections_.find(id);
  return found == connections_.end() || (found->second.stage == Stage::closing && found->second.urgent.empty());
}

bool Hub::overdue(ConnectionId id, std::int64_t now_ns) const {
  const auto found = connections_.find(id);
  return found != connections_.end() && found->second.stage == Stage::closing &&
         now_ns - found->second.closing_since_ns > kClosingLimit;
}

// --- time --------------------------------------------------------------------------------------------------------

void Hub::tick(std::int64_t now_ns) {
  for (const ConnectionId id : connections()) {
    if (const auto found = connections_.find(id); found != connections_.end()) tick(id, found->second, now_ns);
  }
  forget_the_long_gone(now_ns);
}

std::int64_t Hub::handshake_limit(std::int64_t now_ns) const {
  if (end_ == End::server) return kHandshakeLimit;
  return std::min(kHandshakeLimit, quick_limit(now_ns).value_or(kAnswerLimit));
}

void Hub::tick(ConnectionId id, Connection& connection, std::int64_t now_ns) {
  if (connection.stage == Stage::closing) return;
  if (connection.paused_until_ns >= 0) connection.last_read_ns = now_ns;  // it is we who do not listen
  if (now_ns >= connection.paused_until_ns) connection.paused_until_ns = -1;
  if (connection.stage != Stage::open) {
    if (now_ns - connection.opened_ns < handshake_limit(now_ns)) return;
    return fail(id, connection, {ErrorCode::timeout, "the peer did not open the session in time"}, now_ns);
  }
  if (inbound_full()) connection.last_read_ns = now_ns;
  if (now_ns - connection.last_read_ns >= options_.dead_after_ns) {
    return fail(id, connection,
                {ErrorCode::timeout, "nothing came from the peer for too long: it is dead or the link is cut"}, now_ns);
  }
  if (connection.message_began_ns >= 0 && now_ns - connection.message_began_ns >= kMessageLimit && wants_read(id)) {
    return fail(id, connection, {ErrorCode::timeout, "half a message came and the rest did not follow"}, now_ns);
  }
  Peer* peer = peer_of(connection);
  if (peer == nullptr) return;
  const Lane& lane = lane_of(*peer, connection.lane);
  if (now_ns >= connection.next_heartbeat_ns) {
    say(connection, Heartbeat{lane.queued(), lane.dropped()});
    connection.next_heartbeat_ns = now_ns + options_.heartbeat_ns;
  }
  if (connection.lane == LaneName::main && now_ns >= connection.next_clock_ns) {
    say(connection, ClockRequest{now_ns});
    connection.next_clock_ns = now_ns + (++connection.clock_requests < kClockBurst ? kSecond / 50 : kSecond);
  }
}

void Hub::forget_the_long_gone(std::int64_t now_ns) {
  if (end_ == End::client) return;
  std::vector<std::pair<std::int64_t, PeerId>> away;
  for (const auto& [id, peer] : peers_) {
    if (peer.main_connection == 0) away.emplace_back(peer.away_since_ns, id);
  }
  std::sort(away.begin(), away.end());
  std::size_t too_many = away.size() > kMostAway ? away.size() - kMostAway : 0;
  for (const auto& [since_ns, id] : away) {
    if (too_many == 0 && now_ns - since_ns < kSessionLimit) break;
    if (too_many > 0) --too_many;
    forget_peer(id);
  }
}

std::int64_t Hub::next_tick(const Connection& connection, std::int64_t now_ns) const {
  std::int64_t next = now_ns + kSecond;
  const auto sooner = [&](std::int64_t when_ns) { next = std::min(next, std::max(when_ns, now_ns)); };
  if (connection.paused_until_ns >= 0) sooner(connection.paused_until_ns);
  if (connection.stage == Stage::closing) {
    sooner(connection.closing_since_ns + kClosingLimit + 1);
  } else if (connection.stage != Stage::open) {
    sooner(connection.opened_ns + handshake_limit(now_ns));
  } else {
    sooner(connection.next_heartbeat_ns);
    sooner(connection.last_read_ns + options_.dead_after_ns);
    if (connection.lane == LaneName::main) sooner(connection.next_clock_ns);
    if (connection.acknowledge_by_ns >= 0) sooner(connection.acknowledge_by_ns);
    if (connection.message_began_ns >= 0) sooner(connection.message_began_ns + kMessageLimit);
  }
  return next;
}

std::int64_t Hub::next_tick(ConnectionId id, std::int64_t now_ns) const {
  const auto found = connections_.find(id);
  return found == connections_.end() ? now_ns + kSecond : next_tick(found->second, now_ns);
}

std::int64_t Hub::next_tick(std::int64_t now_ns) const {
  std::int64_t next = now_ns + kSecond;
  for (const auto& [id, connection] : connections_) next = std::min(next, next_tick(connection, now_ns));
  if (end_ != End::client) return next;
  const auto sooner = [&](std::int64_t when_ns) { next = std::min(next, std::max(when_ns, now_ns)); };
  if (!main_dial_.busy) sooner(main_dial_.next_ns);
  const auto peer = peers_.find(server_peer_);
  const bool open = peer != peers_.end() && peer->second.main_connection != 0;
  if (open && options_.want_video && !video_dial_.busy) sooner(video_dial_.next_ns);
  return next;
}

void Hub::leave(std::int64_t now_ns) {
  ++changes_;
  for (auto& [id, connection] : connections_) {
    if (connection.stage == Stage::open) say(connection, Bye{options_.software + " has ended"});
    connection.stage = Stage::closing;
    connection.closing_since_ns = now_ns;
  }
}

// --- the program's side ------------------------------------------------------------------------------------------

void Hub::send(PeerId peer, Outgoing message, std::int64_t now_ns) {
  if (const auto found = peers_.find(peer); found != peers_.end()) push(found->second, std::move(message), now_ns);
}

void Hub::broadcast(const Outgoing& message, std::int64_t now_ns) {
  std::vector<PeerId> ids;
  for (const auto& [id, peer] : peers_) ids.push_back(id);
  for (const PeerId id : ids) send(id, message, now_ns);
}

void Hub::push(Peer& peer, Outgoing message, std::int64_t now_ns) {
  const bool video = message.type == MessageType::video;
  if (!wants(peer, message.type)) return;
  if (message.chain != Chain::none && !peer.takes_h264) {
    ++peer.counts.dropped;
    return;
  }
  Lane& lane = lane_of(peer, video ? LaneName::video : LaneName::main);
  lane.push(std::move(message));
  if (!lane.overflowed()) return;
  end_session(peer, {ErrorCode::limit_exceeded, "too many messages wait for a peer that does not take them"}, now_ns);
}

void Hub::report(PeerId peer, const Error& error, std::int64_t now_ns) {
  inbound_.push_back(Received{peer, ErrorReport{static_cast<std::uint16_t>(error.code), error.message}, now_ns});
}

std::vector<Inbound> Hub::take_inbound() {
  std::vector<Inbound> taken = std::exchange(inbound_, {});
  inbound_.reserve(std::min(taken.size(), kLikelyInbound));
  inbound_bytes_ = 0;
  for (auto& [id, peer] : peers_) peer.pictures_waiting = 0;
  return taken;
}

bool Hub::inbound_full() const {
  return inbound_.size() >= kMostInbound || inbound_bytes_ >= kMostInboundBytes;
}

bool Hub::listens(ConnectionId id) const {
  const auto found = connections_.find(id);
  return found != connections_.end() && found->second.stage != Stage::closing;
}

bool Hub::wants_read(ConnectionId id) const {
  const auto found = connections_.find(id);
  return found != connections_.end() && found->second.stage != Stage::closing && found->second.paused_until_ns < 0 &&
         !inbound_full();
}

bool Hub::carries_video(ConnectionId id) const {
  const auto found = connections_.find(id);
  return found != connections_.end() && found->second.stage == Stage::open && found->second.lane == LaneName::video;
}

bool Hub::wants(const Peer& peer, MessageType type) {
  if (type == MessageType::video) return peer.want_video;
  return type != MessageType::debug || peer.want_debug;
}

bool Hub::wanted(MessageType type) const {
  if (type != MessageType::video && type != MessageType::debug) return true;
  return std::any_of(peers_.begin(), peers_.end(), [&](const auto& known) { return wants(known.second, type); });
}

bool Hub::all_take_h264() const {
  return std::all_of(peers_.begin(), peers_.end(), [](const auto& known) {
    const Peer& peer = known.second;
    return !peer.want_video || peer.main_connection == 0 || peer.takes_h264;
  });
}

void Hub::count_dropped(PeerId peer) {
  if (const auto found = peers_.find(peer); found != peers_.end()) ++found->second.counts.dropped;
}

ConnectionId Hub::carrier(PeerId id, MessageType type) const {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return 0;
  return type == MessageType::video ? found->second.video_connection : found->second.main_connection;
}

bool Hub::keeps(PeerId id, MessageType type) const {
  const auto found = peers_.find(id);
  return found != peers_.end() && found->second.main.keeps(type);
}

std::uint64_t Hub::dropped_pictures() const {
  std::uint64_t dropped = 0;
  for (const auto& [id, peer] : peers_) {
    if (peer.video_connection != 0) dropped += peer.video.dropped();
  }
  return dropped;
}

std::uint32_t Hub::waiting_pictures() const {
  std::uint32_t most = 0;
  for (const auto& [id, peer] : peers_) {
    if (peer.video_connection != 0) most = std::max(most, peer.video.queued());
  }
  return most;
}

std::vector<PeerStats> Hub::stats(std::int64_t now_ns) const {
  std::vector<PeerStats> all;
  for (const auto& [id, peer] : peers_) {
    PeerStats stats = peer.counts;
    stats.dropped += peer.main.dropped() + peer.video.dropped();
    stats.queued = peer.main.queued() + peer.video.queued();
    stats.unacknowledged = peer.main.unacknowledged() + peer.video.unacknowledged();
    const ClockOffset clock = peer.clock.at(now_ns);
    stats.clock_offset_ns = clock.offset_ns;
    stats.clock_bound_ns = clock.bound_ns;
    stats.round_trip_ns = clock.round_trip_ns;
    all.push_back(stats);
  }
  return all;
}

}  // namespace counterpart
