// The messages of a capture, decoded, in the order in which they went over the wire.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "protocol/capture/mcap_reader.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct RecordedMessage {
  bool incoming = false;  // for the program that recorded
  bool video_lane = false;
  std::uint32_t peer = 0;
  std::int64_t log_ns = 0;  // recorder's monotonic clock
  std::uint64_t seq = 0;    // of kept messages
  Message message;
};

// False for the link's own messages: handshakes, heartbeats, clocks, acknowledgements.
bool is_about_the_game(MessageType type);

class SessionReader {
 public:
  [[nodiscard]] static Result<std::unique_ptr<SessionReader>> open(const std::string& path);

  // Empty: there are no more. Messages of unknown type and damaged ones are passed over and counted.
  std::optional<RecordedMessage> next();

  // True for what a program of this role said about the game, the picture and the human: not the link's own messages,
  // and nothing twice that was sent twice because a link was lost. A camera's pictures are in its tracker's capture.
  bool sent_by(Role role, const RecordedMessage& recorded);

  std::uint64_t passed_over() const { return passed_over_; }
  const std::optional<Error>& problem() const { return reader_->problem(); }
  const McapReader& file() const { return *reader_; }

 private:
  explicit SessionReader(std::unique_ptr<McapReader> reader) : reader_(std::move(reader)) {}

  void learn_roles(const RecordedMessage& recorded);

  std::unique_ptr<McapReader> reader_;
  std::optional<Role> last_hello_role_;
  std::map<std::uint32_t, Role> peer_roles_;  // of a server's capture
  Role role_ = Role::observer;
  std::uint64_t passed_over_ = 0;
  std::map<std::pair<std::uint32_t, bool>, std::uint64_t> last_seq_;  // by peer and lane
};

}  // namespace counterpart
