#include "protocol/capture/session_reader.hpp"

#include "protocol/capture/wire_record.hpp"
#include "protocol/codec/codec.hpp"
#include "protocol/codec/names.hpp"

namespace counterpart {

namespace {

// To whom a program of this role mostly speaks.
Role counterpart_of(Role role) {
  return role == Role::tracker ? Role::renderer : Role::tracker;
}

}  // namespace

Result<std::unique_ptr<SessionReader>> SessionReader::open(const std::string& path) {
  auto file = McapReader::open(path);
  if (!file) return tl::make_unexpected(file.error());
  return std::unique_ptr<SessionReader>(new SessionReader(std::move(*file)));
}

std::optional<RecordedMessage> SessionReader::next() {
  while (auto entry = reader_->next()) {
    if (entry->topic != "/wire") continue;
    const auto wire = read_wire_record(entry->data);
    if (!wire || !is_known(wire->header.type)) {
      ++passed_over_;
      continue;
    }
    auto message = decode(static_cast<MessageType>(wire->header.type), wire->body);
    if (!message) {
      ++passed_over_;
      continue;
    }
    RecordedMessage recorded;
    recorded.incoming = wire->incoming;
    recorded.video_lane = wire->video_lane;
    recorded.peer = wire->peer;
    recorded.log_ns = static_cast<std::int64_t>(entry->log_ns);
    recorded.seq = wire->header.seq;
    recorded.message = std::move(*message);
    learn_roles(recorded);
    return recorded;
  }
  return std::nullopt;
}

bool is_about_the_game(MessageType type) {
  switch (type) {
    case MessageType::hello:
    case MessageType::welcome:
    case MessageType::challenge:
    case MessageType::proof:
    case MessageType::heartbeat:
    case MessageType::error:
    case MessageType::bye:
    case MessageType::clock_request:
    case MessageType::clock_response:
    case MessageType::acknowledge:
      return false;
    default:
      return true;
  }
}

// A server answers HELLO at once, so the WELCOME that follows names the peer that said it.
void SessionReader::learn_roles(const RecordedMessage& recorded) {
  if (const auto* hello = std::get_if<Hello>(&recorded.message)) last_hello_role_ = hello->role;
  if (std::holds_alternative<Welcome>(recorded.message) && !recorded.incoming && last_hello_role_) {
    peer_roles_[recorded.peer] = *last_hello_role_;
  }
}

bool SessionReader::sent_by(Role role, const RecordedMessage& recorded) {
  if (const auto session = reader_->metadata().find("session"); session != reader_->metadata().end()) {
    if (const auto found = session->second.find("role"); found != session->second.end()) {
      role_ = from_name<Role>(found->second).value_or(Role::observer);
    }
  }
  if (role == Role::camera && role_ != Role::camera) {
    // A tracker passes on what its camera gave it.
    const bool of_camera =
        std::holds_alternative<VideoFrame>(recorded.message) || std::holds_alternative<Intrinsics>(recorded.message);
    return of_camera && sent_by(Role::tracker, recorded);
  }
  if (recorded.incoming == (role_ == role)) return false;
  const auto peer_role = peer_roles_.find(recorded.peer);
  const Role wanted = recorded.incoming ? role : counterpart_of(role);
  if (peer_role != peer_roles_.end() && peer_role->second != wanted) return false;
  if (!is_about_the_game(type_of(recorded.message))) return false;
  if (recorded.seq == 0) return true;
  std::uint64_t& last = last_seq_[{recorded.peer, recorded.video_lane}];
  if (recorded.seq <= last) return false;
  last = recorded.seq;
  return true;
}

}  // namespace counterpart
