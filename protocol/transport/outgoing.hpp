// A message as it waits to be sent.
#pragma once

#include "protocol/session/lane.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Raw pictures are turned into `codec` first.
[[nodiscard]] Result<Outgoing> make_outgoing(const Message& message, PixelCodec codec);

}  // namespace counterpart
