// What waits to be sent on one lane (main or video) of a session, and what has arrived on it. It outlives connections.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "protocol/codec/bytes.hpp"
#include "protocol/vocabulary/message.hpp"

namespace counterpart {

// Of pictures that build on earlier ones.
enum class Chain : std::uint8_t { none, begins, goes_on };

struct Outgoing {
  MessageType type = MessageType::heartbeat;
  std::uint32_t object = 0;  // latest-wins goes by type and object
  FrameId frame_id = 0;
  std::uint64_t seq = 0;  // 0: not kept
  Chain chain = Chain::none;
  std::shared_ptr<const Bytes> body;
};

class Lane {
 public:
  explicit Lane(bool lockstep = false) : lockstep_(lockstep) {}

  void set_lockstep(bool lockstep) { lockstep_ = lockstep; }

  bool keeps(MessageType type) const;

  // Kept messages are numbered; of the others the newest few stay.
  void push(Outgoing message);

  // The next one to go out on the current connection, valid until another one is taken or acknowledged; null: none.
  const Outgoing* take();

  // The other side has everything up to and with `seq`. False: it names a message that was never sent.
  bool acknowledge(std::uint64_t seq);

  // A new connection: everything after `seq` goes out again. False as above.
  bool resume(std::uint64_t seq);

  enum class Arrival { fresh, duplicate, gap };
  Arrival arrived(std::uint64_t seq);

  std::uint64_t last_received() const { return last_received_; }
  bool has_waiting() const { return !waiting_.empty(); }
  std::uint32_t queued() const { return static_cast<std::uint32_t>(waiting_.size()); }
  std::uint32_t unacknowledged() const { return static_cast<std::uint32_t>(kept_count_); }
  std::uint64_t dropped() const { return dropped_; }

  // Kept messages that were not acknowledged yet are too many or too large: the session cannot go on.
  bool overflowed() const;

 private:
  bool drop_for(const Outgoing& message);

  bool lockstep_ = false;
  std::deque<Outgoing> waiting_;
  std::deque<Outgoing> unacknowledged_;  // kept and already given out, in order
  Outgoing passing_;                     // the last one given out that is not kept
  std::uint64_t next_seq_ = 1;
  std::uint64_t last_given_out_ = 0;
  std::uint64_t last_received_ = 0;
  std::uint64_t dropped_ = 0;
  std::size_t kept_count_ = 0;
  std::size_t kept_bytes_ = 0;
};

}  // namespace counterpart
