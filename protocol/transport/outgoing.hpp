// A message as it waits to be sent.
#pragma once

#include <memory>

#include "protocol/session/lane.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Raw pictures are turned into `codec` first. The body goes into `memory`, which nobody else may be using.
[[nodiscard]] Result<Outgoing> make_outgoing(const Message& message, PixelCodec codec,
                                             std::shared_ptr<Bytes> memory = std::make_shared<Bytes>());

}  // namespace counterpart
