// One end of a link, whatever carries it: TCP, memory or a recorded file. The daemons know nothing below this.
//
// An endpoint hides connections, video's own connection, reconnection, heartbeats, acknowledgement and clocks. Messages
// of one peer are delivered in the order they were sent, except that VIDEO travels beside the others: pair it by
// frame_id. All functions may be called from one thread; the endpoint's own work is done elsewhere.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/transport/video_coding.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

using PeerId = std::uint32_t;  // never reused within one endpoint's life

struct PeerJoined {
  PeerId peer = 0;
  Role role = Role::observer;
  std::string software;
  bool resumed = false;   // the same session after a lost link: nothing kept was lost. false: a fresh process
  bool lockstep = false;  // both sides asked for it
};

// May come a second time for a peer that is away: when its session is given up.
struct PeerLeft {
  PeerId peer = 0;
  Error reason;
  bool said_goodbye = false;  // it ended its session with BYE; false: the link was lost, it may resume
};

struct Received {
  PeerId peer = 0;
  Message message;
  std::int64_t received_ns = 0;  // monotonic
};

using Inbound = std::variant<PeerJoined, PeerLeft, Received>;

struct PeerStats {
  PeerId peer = 0;
  Role role = Role::observer;
  std::uint64_t sent = 0, received = 0;  // messages
  std::uint64_t bytes_sent = 0, bytes_received = 0;
  std::uint64_t dropped = 0;         // latest-wins messages replaced before they went out
  std::uint64_t skipped = 0;         // received messages of unknown type
  std::uint32_t queued = 0;          // waiting to go out
  std::uint32_t unacknowledged = 0;  // kept messages that the peer has not confirmed, queued ones included
  std::int64_t clock_offset_ns = 0;  // peer's monotonic clock minus ours
  std::int64_t clock_bound_ns = -1;  // half-width of the interval that surely holds the offset; -1: not known yet
  std::int64_t round_trip_ns = -1;
};

class Endpoint {
 public:
  virtual ~Endpoint() = default;

  // Queued, never blocks. A peer that is away gets kept messages when it resumes, and the newest of the others.
  virtual void send(PeerId peer, const Message& message) = 0;
  virtual void broadcast(const Message& message) = 0;

  // Everything that came, in order; waits up to timeout_ns for the first. 0: does not wait.
  virtual std::vector<Inbound> receive(std::int64_t timeout_ns) = 0;

  virtual std::vector<PeerStats> stats() const = 0;

  // host:port that is listened on, or connected to.
  virtual std::string address() const = 0;
};

struct LinkOptions {
  Role role = Role::observer;
  std::string software;  // "vhd_renderer 0.1.0"
  bool lockstep = false;
  std::string token_file;  // needed for a listening address other than loopback
  std::string tls_file;  // TLS 1.3 with this identity (transport/tls.hpp), and with nobody who has none; empty: no TLS
  // Raw pictures are turned into this before they are sent. Empty: raw on loopback, between hosts what the links carry
  // (transport/video_choice.hpp). h264 goes out as JPEG while there is a viewer who does not take it.
  std::optional<PixelCodec> video_codec;
  bool want_video = true;
  bool want_debug = false;  // DEBUG, 50 kB a frame
  bool takes_h264 = false;  // pictures may come in H.264
  VideoCoding h264;         // without an encoder none is sent; without a decoder what comes is handed on as it is
  std::int64_t heartbeat_ns = 500'000'000;
  std::int64_t dead_after_ns = 1'400'000'000;  // noticed within 1.5 s also by a busy machine
  std::string record_file;                     // every message and the exact bytes, as MCAP; empty: no capture
};

// address: "HOST:PORT"; port 0 takes a free one (see Endpoint::address).
[[nodiscard]] Result<std::unique_ptr<Endpoint>> listen_tcp(const std::string& address, const LinkOptions& options);

// Returns at once and keeps trying with growing waits; the peer shows up as PeerJoined. wait_ns > 0: waits so long for
// the first connection and fails with a sentence if there is none, or if the peer refuses (version, token).
[[nodiscard]] Result<std::unique_ptr<Endpoint>> connect_tcp(const std::string& address, const LinkOptions& options,
                                                            std::int64_t wait_ns = 0);

// Two ends in one process, for tests: the same sessions and codec, no sockets.
[[nodiscard]] std::pair<std::unique_ptr<Endpoint>, std::unique_ptr<Endpoint>> memory_link(const LinkOptions& a,
                                                                                          const LinkOptions& b);

}  // namespace counterpart
