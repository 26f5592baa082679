// The words that stand for enumerators in JSON, on command lines and in tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Defined for MessageType, Role, Side, GamePhase, GameResult, EventKind, ControlKind, Hand, BodyPart, GazeTarget,
// FeedbackState, SquareColour, TrackStatus, PixelCodec and ErrorCode. A value that has no name gives "".
template <class E>
std::string_view name_of(E value);

template <class E>
std::optional<E> from_name(std::string_view name);

// "a, b, c": for messages that say what is permitted.
template <class E>
std::string all_names();

// The verb of a command: "grasp", "keyframe", ...
std::string_view verb_of(const Action& action);

}  // namespace counterpart
