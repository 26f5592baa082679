// A message as it waits to be sent.
#pragma once

#include <memory>

#include "protocol/session/lane.hpp"
#include "protocol/transport/video_choice.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Raw pictures are given this form first. The body goes into `memory`, which nobody else may be using.
[[nodiscard]] Result<Outgoing> make_outgoing(const Message& message, const VideoForm& form,
                                             std::shared_ptr<Bytes> memory = std::make_shared<Bytes>());

}  // namespace counterpart
