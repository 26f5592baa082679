// One end of a link as a pure state machine: sessions, lanes, handshakes, heartbeats. It knows no sockets and no clock;
// a transport carries its bytes and tells it the time. All times are monotonic nanoseconds. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/framing/frame_parser.hpp"
#include "protocol/session/clock_sync.hpp"
#include "protocol/session/lane.hpp"
#include "protocol/session/rate_limit.hpp"
#include "protocol/session/token.hpp"
#include "protocol/transport/endpoint.hpp"

namespace counterpart {

using ConnectionId = std::uint32_t;

// One message on its way to a connection.
struct WireMessage {
  HeaderBytes header{};
  std::shared_ptr<const Bytes> body;
};

// Sees the exact bytes of every message that goes through a hub; a capture is one.
class WireTap {
 public:
  virtual ~WireTap() = default;
  virtual void saw(bool incoming, bool video_lane, PeerId peer, const HeaderBytes& header, ByteView body,
                   std::int64_t now_ns) = 0;
  virtual std::optional<Error> take_error() { return std::nullopt; }
};

class Hub {
 public:
  enum class End { client, server };

  Hub(End end, LinkOptions options, std::string token, WireTap* tap = nullptr);

  // --- the transport's side -------------------------------------------------------------------------------------
  // Server: a connection was accepted. Empty: there are too many; close it after writing what refusal() says.
  std::optional<ConnectionId> accepted(std::int64_t now_ns);
  WireMessage refusal(std::int64_t now_ns) const;

  // Client: the lane that should be connected now, if any; the transport then calls dialled or dial_failed.
  enum class LaneName { main, video };
  std::optional<LaneName> wants_to_dial(std::int64_t now_ns);
  ConnectionId dialled(LaneName lane, std::int64_t now_ns);
  std::int64_t dial_limit(std::int64_t now_ns) const;  // how long connecting may take
  void dial_failed(LaneName lane, const Error& why, std::int64_t now_ns);

  // Where bytes of the connection go, and that `count` of them came.
  FrameParser& parser(ConnectionId connection);
  void read(ConnectionId connection, std::size_t count, std::int64_t now_ns);
  bool wants_read(ConnectionId connection) const;
  bool listens(ConnectionId connection) const;  // what comes is still heard, wanted just now or not

  // The next message to write on it.
  std::optional<WireMessage> next_to_write(ConnectionId connection, std::int64_t now_ns);
  // True once nothing more will be written: the transport closes the socket and calls closed().
  bool finished(ConnectionId connection) const;
  // It should have been finished by now, but its last words do not go out: close it anyway.
  bool overdue(ConnectionId connection, std::int64_t now_ns) const;
  bool exists(ConnectionId connection) const { return connections_.count(connection) > 0; }
  bool carries_video(ConnectionId connection) const;
  bool wanted(MessageType type) const;                        // false: nobody has asked for it
  bool all_take_h264() const;                                 // who is there and wants pictures
  ConnectionId carrier(PeerId peer, MessageType type) const;  // on which messages of this type go to it; 0: none now
  bool keeps(PeerId peer, MessageType type) const;            // none of these is lost or replaced by a newer one
  // Grows whenever connections or sessions come, go or change: what concerns one connection alone leaves it as it is.
  std::uint64_t changes() const { return changes_; }
  std::uint64_t dropped_pictures() const;  // by newer ones, of all peers that are there
  std::uint32_t waiting_pictures() const;  // to go out, of the peer that has the most
  void count_dropped(PeerId peer);         // a message that came and was of no use
  void closed(ConnectionId connection, Error why, std::int64_t now_ns);

  // Heartbeats, deadlines, clock requests. next_tick: when it should be called at the latest.
  void tick(std::int64_t now_ns);
  std::int64_t next_tick(std::int64_t now_ns) const;
  std::int64_t next_tick(ConnectionId connection, std::int64_t now_ns) const;  // for this connection's sake

  std::vector<ConnectionId> connections() const;

  // Says goodbye on every open connection.
  void leave(std::int64_t now_ns);

  // --- the program's side ---------------------------------------------------------------------------------------
  void send(PeerId peer, Outgoing message, std::int64_t now_ns);
  void broadcast(const Outgoing& message, std::int64_t now_ns);
  void report(PeerId peer, const Error& error, std::int64_t now_ns);  // a local trouble, as an ErrorReport
  std::vector<Inbound> take_inbound();
  bool has_inbound() const { return !inbound_.empty(); }
  std::vector<PeerStats> stats(std::int64_t now_ns) const;

  // Client: why the last attempt to open a session failed.
  const std::optional<Error>& last_refusal() const { return last_refusal_; }

 private:
  // Messages of a connection that cost work: texts to parse, questions to answer.
  static constexpr std::int64_t kMostWorkPerSecond = 5'000;
  static constexpr std::int64_t kMostWorkAtOnce = 10'000;

  enum class Stage { waiting_for_hello, waiting_for_proof, waiting_for_welcome, open, closing };

  struct Peer {
    PeerId id = 0;
    std::uint64_t session = 0;
    Role role = Role::observer;
    std::string software;
    bool want_video = false;
    bool want_debug = false;
    bool lockstep = false;
    bool takes_h264 = false;
    Lane main, video;
    ConnectionId main_connection = 0, video_connection = 0;  // 0: none
    std::int64_t away_since_ns = 0;
    ClockSync clock;
    PeerStats counts;
    int pictures_waiting = 0;  // in inbound_
  };

  struct Connection {
    Stage stage = Stage::waiting_for_hello;
    LaneName lane = LaneName::main;
    PeerId peer = 0;  // 0: not yet
    FrameParser parser;
    std::deque<Outgoing> urgent;  // handshake, acknowledgements, heartbeats: before everything that waits in the lane
    Bytes hello_body;             // for the proof
    std::optional<Hello> hello;
    Bytes32 server_nonce{}, client_nonce{};
    bool server_proved = false;
    std::int64_t opened_ns = 0;
    std::int64_t last_read_ns = 0;
    std::int64_t message_began_ns = -1;
    std::int64_t next_heartbeat_ns = 0;
    std::int64_t next_clock_ns = 0;
    int clock_requests = 0;
    std::int64_t closing_since_ns = 0;
    std::int64_t acknowledge_by_ns = -1;  // -1: everything is acknowledged
    std::size_t unacknowledged_bytes = 0;
    RateLimit rate{kMostWorkPerSecond, kMostWorkAtOnce};
    std::int64_t paused_until_ns = -1;  // what comes too fast is left in the socket; -1: it is read
  };

  struct Dial {
    bool busy = false;  // being connected, or connected
    std::int64_t began_ns = 0;
    std::int64_t next_ns = 0;
    std::int64_t wait_ns = 0;
  };

  static bool wants(const Peer& peer, MessageType type);
  Peer* peer_of(const Connection& connection);
  Lane& lane_of(Peer& peer, LaneName lane) { return lane == LaneName::main ? peer.main : peer.video; }
  ConnectionId add_connection(std::int64_t now_ns);
  void say(Connection& connection, const Message& message);
  void fail(ConnectionId id, Connection& connection, const Error& error, std::int64_t now_ns);
  void drop(ConnectionId id, const Error& why, std::int64_t now_ns, bool said_goodbye = false);
  void detach(ConnectionId id, Connection& connection, const Error& why, std::int64_t now_ns,
              bool said_goodbye = false);
  void forget_peer(PeerId id);
  void end_session(Peer& peer, const Error& why, std::int64_t now_ns);
  void push(Peer& peer, Outgoing message, std::int64_t now_ns);
  void tick(ConnectionId id, Connection& connection, std::int64_t now_ns);
  void begin_dial(Dial& dial, std::int64_t now_ns);
  std::optional<std::int64_t> quick_limit(std::int64_t now_ns) const;
  std::int64_t handshake_limit(std::int64_t now_ns) const;
  std::int64_t next_tick(const Connection& connection, std::int64_t now_ns) const;
  void forget_the_long_gone(std::int64_t now_ns);
  void try_again_later(Dial& dial, std::int64_t now_ns);
  void note_refusal(const Error& why);
  bool inbound_full() const;

  // hub_handshake.cpp
  void begin_hello(ConnectionId id, Connection& connection, std::int64_t now_ns);
  [[nodiscard]] Result<void> handshake(ConnectionId id, Connection& connection, const RawMessage& raw,
                                       const Message& message, std::int64_t now_ns);
  [[nodiscard]] Result<void> on_hello(ConnectionId id, Connection& connection, const RawMessage& raw,
                                      const Hello& hello, std::int64_t now_ns);
  [[nodiscard]] Result<void> admit(ConnectionId id, Connection& connection, std::int64_t now_ns);
  [[nodiscard]] Result<void> on_client_proof(ConnectionId id, Connection& connection, const Proof& proof,
                                             std::int64_t now_ns);
  [[nodiscard]] Result<void> on_challenge(Connection& connection, const Challenge& challenge);
  [[nodiscard]] Result<void> on_server_proof(Connection& connection, const Proof& proof);
  [[nodiscard]] Result<void> on_welcome(ConnectionId id, Connection& connection, const Welcome& welcome,
                                        std::int64_t now_ns);
  Peer& make_peer(std::uint64_t session, Role role, const std::string& software, bool lockstep);
  void attach(ConnectionId id, Connection& connection, Peer& peer, bool resumed, std::int64_t now_ns);

  // hub_receive.cpp
  [[nodiscard]] Result<void> on_message(ConnectionId id, Connection& connection, RawMessage& raw, std::int64_t now_ns);
  static void count_work(Connection& connection, MessageType type, std::int64_t now_ns);
  void acknowledge_soon(Connection& connection, std::size_t bytes, std::int64_t now_ns);
  [[nodiscard]] Result<void> on_open_message(ConnectionId id, Connection& connection, const Header& header,
                                             Message&& message, std::int64_t now_ns);
  void deliver(Peer& peer, Message&& message, std::int64_t now_ns);

  End end_;
  LinkOptions options_;
  std::string token_;
  WireTap* tap_ = nullptr;
  std::map<ConnectionId, Connection> connections_;
  std::map<PeerId, Peer> peers_;
  std::map<std::uint64_t, PeerId> sessions_;
  std::vector<Inbound> inbound_;
  std::size_t inbound_bytes_ = 0;
  std::uint64_t changes_ = 0;
  ConnectionId last_connection_ = 0;
  PeerId last_peer_ = 0;
  PeerId server_peer_ = 0;  // client: the peer of the current session
  Dial main_dial_, video_dial_;
  std::optional<Error> last_refusal_;
  std::string last_reported_refusal_;
};

}  // namespace counterpart
