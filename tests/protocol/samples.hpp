// One message of every type, with every field off its default.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "protocol/vocabulary/message.hpp"

namespace counterpart {

// Name and message; the names are those of tests/data/protocol_v1.txt.
std::vector<std::pair<std::string, Message>> sample_messages();

}  // namespace counterpart
