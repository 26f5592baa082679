#include "protocol/vocabulary/message.hpp"

#include <array>

namespace counterpart {
namespace {

// In the order of the variant's alternatives.
constexpr std::array kTypes{
    MessageType::hello,      MessageType::welcome,       MessageType::heartbeat,      MessageType::error,
    MessageType::bye,        MessageType::clock_request, MessageType::clock_response, MessageType::acknowledge,
    MessageType::intrinsics, MessageType::pose,          MessageType::video,          MessageType::mask,
    MessageType::debug,      MessageType::frame_done,    MessageType::board_state,    MessageType::game_event,
    MessageType::control,    MessageType::scene,         MessageType::command,        MessageType::feedback,
    MessageType::challenge,  MessageType::proof,
};
static_assert(kTypes.size() == std::variant_size_v<Message>);

}  // namespace

MessageType type_of(const Message& message) {
  return kTypes.at(message.index());
}

bool is_kept(MessageType type) {
  switch (type) {
    case MessageType::intrinsics:
    case MessageType::frame_done:
    case MessageType::board_state:
    case MessageType::game_event:
    case MessageType::control:
    case MessageType::scene:
    case MessageType::command:
    case MessageType::feedback:
      return true;
    default:
      return false;
  }
}

}  // namespace counterpart
