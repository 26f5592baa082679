#include "protocol/codec/codec.hpp"
#include "protocol/session/hub.hpp"
#include "protocol/session/version.hpp"

namespace counterpart {

void Hub::begin_hello(ConnectionId id, Connection& connection, std::int64_t now_ns) {
  Hello hello;
  hello.version_min = kVersionMin;
  hello.version_max = kVersionMax;
  hello.role = options_.role;
  hello.software = options_.software;
  hello.video = connection.lane == LaneName::video;
  hello.want_video = options_.want_video;
  hello.lockstep = options_.lockstep;
  hello.h264 = options_.takes_h264;
  hello.want_debug = options_.want_debug;
  if (const auto peer = peers_.find(server_peer_); peer != peers_.end()) {
    hello.resume_session = peer->second.session;
    hello.last_seq = lane_of(peer->second, connection.lane).last_received();
  }
  connection.stage = Stage::waiting_for_welcome;
  connection.hello = hello;
  auto body = encode(hello);
  if (!body) return fail(id, connection, body.error(), now_ns);
  connection.hello_body = *body;
  say(connection, hello);
}

Result<void> Hub::handshake(ConnectionId id, Connection& connection, const RawMessage& raw, const Message& message,
                            std::int64_t now_ns) {
  if (const auto* error = std::get_if<ErrorReport>(&message)) {
    return failure(static_cast<ErrorCode>(error->code), error->message);
  }
  switch (connection.stage) {
    case Stage::waiting_for_hello:
      if (const auto* hello = std::get_if<Hello>(&message)) return on_hello(id, connection, raw, *hello, now_ns);
      return failure(ErrorCode::bad_format, "the peer did not begin with HELLO");
    case Stage::waiting_for_proof:
      if (const auto* proof = std::get_if<Proof>(&message)) return on_client_proof(id, connection, *proof, now_ns);
      return failure(ErrorCode::refused, "the peer did not prove that it knows the token");
    default:
      break;
  }
  if (const auto* challenge = std::get_if<Challenge>(&message)) return on_challenge(connection, *challenge);
  if (const auto* proof = std::get_if<Proof>(&message)) return on_server_proof(connection, *proof);
  if (const auto* welcome = std::get_if<Welcome>(&message)) return on_welcome(id, connection, *welcome, now_ns);
  return failure(ErrorCode::bad_format, "the peer did not answer HELLO with WELCOME");
}

// --- server ------------------------------------------------------------------------------------------------------

Result<void> Hub::on_hello(ConnectionId id, Connection& connection, const RawMessage& raw, const Hello& hello,
                           std::int64_t now_ns) {
  if (auto version = agree_on_version(hello.version_min, hello.version_max); !version) {
    return tl::make_unexpected(version.error());
  }
  connection.hello = hello;
  connection.hello_body = raw.body;
  connection.lane = hello.video ? LaneName::video : LaneName::main;
  if (token_.empty()) return admit(id, connection, now_ns);
  connection.server_nonce = random_bytes();
  connection.stage = Stage::waiting_for_proof;
  say(connection, Challenge{connection.server_nonce});
  return {};
}

Result<void> Hub::on_client_proof(ConnectionId id, Connection& connection, const Proof& proof, std::int64_t now_ns) {
  const auto expected = prove(token_, Prover::client, connection.server_nonce, proof.nonce, connection.hello_body);
  if (!same(expected, proof.mac)) {
    return failure(ErrorCode::refused, "the token is not the right one: both sides need the same token file");
  }
  say(connection, Proof{connection.server_nonce,
                        prove(token_, Prover::server, connection.server_nonce, proof.nonce, connection.hello_body)});
  return admit(id, connection, now_ns);
}

Result<void> Hub::admit(ConnectionId id, Connection& connection, std::int64_t now_ns) {
  const Hello& hello = *connection.hello;
  const auto known = sessions_.find(hello.resume_session);
  bool resumed = hello.resume_session != 0 && known != sessions_.end();
  if (hello.video && !resumed) return failure(ErrorCode::not_found, "the session of this video connection is gone");
  // What was lost cannot be sent again: such a peer has to start afresh.
  if (resumed && !lane_of(peers_.at(known->second), connection.lane).resume(hello.last_seq)) resumed = false;
  if (hello.video && !resumed) return failure(ErrorCode::bad_format, "the peer has seen messages never sent to it");
  if (!resumed && known != sessions_.end() && hello.resume_session != 0) forget_peer(known->second);
  Peer& peer = resumed ? peers_.at(known->second)
                       : make_peer(random_session(), hello.role, hello.software, hello.lockstep && options_.lockstep);
  peer.want_video = hello.want_video || hello.video;
  if (!hello.video) {
    peer.want_debug = hello.want_debug;
    peer.takes_h264 = hello.h264;
  }
  Welcome welcome;
  welcome.version = *agree_on_version(hello.version_min, hello.version_max);
  welcome.session = peer.session;
  welcome.role = options_.role;
  welcome.software = options_.software;
  welcome.resumed = resumed;
  welcome.last_seq = lane_of(peer, connection.lane).last_received();
  welcome.lockstep = peer.lockstep;
  say(connection, welcome);
  attach(id, connection, peer, resumed, now_ns);
  return {};
}

// --- client ------------------------------------------------------------------------------------------------------

Result<void> Hub::on_challenge(Connection& connection, const Challenge& challenge) {
  if (token_.empty()) {
    return failure(ErrorCode::refused, "the peer asks for a token; give its token file with --token-file");
  }
  connection.server_nonce = challenge.nonce;
  connection.client_nonce = random_bytes();
  say(connection, Proof{connection.client_nonce, prove(token_, Prover::client, connection.server_nonce,
                                                       connection.client_nonce, connection.hello_body)});
  return {};
}

Result<void> Hub::on_server_proof(Connection& connection, const Proof& proof) {
  const auto expected =
      prove(token_, Prover::server, connection.server_nonce, connection.client_nonce, connection.hello_body);
  if (token_.empty() || !same(expected, proof.mac)) {
    return failure(ErrorCode::refused, "the peer did not prove that it knows the token");
  }
  connection.server_proved = true;
  return {};
}

Result<void> Hub::on_welcome(ConnectionId id, Connection& connection, const Welcome& welcome, std::int64_t now_ns) {
  if (auto version = agree_on_version(welcome.version, welcome.version); !version) {
    return tl::make_unexpected(version.error());
  }
  if (!token_.empty() && !connection.server_proved) {
    return failure(ErrorCode::refused, "the peer did not prove that it knows the token");
  }
  const auto known = peers_.find(server_peer_);
  const bool same_session = known != peers_.end() && known->second.session == welcome.session;
  if (connection.lane == LaneName::video && !(welcome.resumed && same_session)) {
    return failure(ErrorCode::bad_format, "the peer gave the video connection another session");
  }
  const bool resumed = welcome.resumed && same_session;
  if (resumed && !lane_of(known->second, connection.lane).resume(welcome.last_seq)) {
    forget_peer(server_peer_);
    return failure(ErrorCode::bad_format, "the peer has seen messages never sent to it");
  }
  if (!resumed && known != peers_.end()) forget_peer(server_peer_);
  Peer& peer = resumed ? known->second : make_peer(welcome.session, welcome.role, welcome.software, welcome.lockstep);
  peer.want_video = options_.want_video;
  peer.want_debug = true;  // a server takes what comes
  server_peer_ = peer.id;
  last_refusal_.reset();
  last_reported_refusal_.clear();
  attach(id, connection, peer, resumed, now_ns);
  return {};
}

// --- both --------------------------------------------------------------------------------------------------------

Hub::Peer& Hub::make_peer(std::uint64_t session, Role role, const std::string& software, bool lockstep) {
  Peer peer;
  peer.id = ++last_peer_;
  peer.session = session;
  peer.role = role;
  peer.software = software;
  peer.lockstep = lockstep;
  peer.main.set_lockstep(lockstep);
  peer.video.set_lockstep(lockstep);
  peer.counts.peer = peer.id;
  peer.counts.role = role;
  sessions_[session] = peer.id;
  return peers_.emplace(peer.id, std::move(peer)).first->second;
}

void Hub::attach(ConnectionId id, Connection& connection, Peer& peer, bool resumed, std::int64_t now_ns) {
  ConnectionId& slot = connection.lane == LaneName::main ? peer.main_connection : peer.video_connection;
  const ConnectionId before = slot;
  slot = id;
  ++changes_;
  connection.peer = peer.id;
  connection.stage = Stage::open;
  connection.next_heartbeat_ns = now_ns + options_.heartbeat_ns;
  connection.next_clock_ns = now_ns;
  if (before != 0) drop(before, {ErrorCode::closed, "the peer has connected again"}, now_ns);
  Dial& dial = connection.lane == LaneName::main ? main_dial_ : video_dial_;
  dial.wait_ns = 0;
  if (connection.lane == LaneName::video) return;
  if (before != 0) inbound_.push_back(PeerLeft{peer.id, {ErrorCode::closed, "the peer has connected again"}, false});
  PeerJoined joined;
  joined.peer = peer.id;
  joined.role = peer.role;
  joined.software = peer.software;
  joined.resumed = resumed;
  joined.lockstep = peer.lockstep;
  inbound_.push_back(joined);
}

}  // namespace counterpart
