// The vocabulary as JSON: docs/protocol.md, section 2. Reading is strict about types and ranges, passes over unknown
// keys, and says which key is wrong. Never throws.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// For every message that travels as JSON: Hello, Welcome, ErrorReport, Bye, Challenge, Proof, Intrinsics, DebugView,
// BoardState, GameEvent, Control, Scene, Command, Feedback; and BoardGeometry and Pose, which are parts of them.
nlohmann::json to_json(const Hello& value);
nlohmann::json to_json(const Welcome& value);
nlohmann::json to_json(const ErrorReport& value);
nlohmann::json to_json(const Bye& value);
nlohmann::json to_json(const Challenge& value);
nlohmann::json to_json(const Proof& value);
nlohmann::json to_json(const Intrinsics& value);  // camera.json
nlohmann::json to_json(const DebugView& value);
nlohmann::json to_json(const BoardState& value);
nlohmann::json to_json(const GameEvent& value);
nlohmann::json to_json(const Control& value);
nlohmann::json to_json(const Scene& value);
nlohmann::json to_json(const Command& value);
nlohmann::json to_json(const Feedback& value);
nlohmann::json to_json(const BoardGeometry& value);
nlohmann::json to_json(const Pose& value);

// The fixed-size messages as JSON, for people (vhp --json); a picture is given by its size. There is no way back.
nlohmann::json to_json(const Heartbeat& value);
nlohmann::json to_json(const ClockRequest& value);
nlohmann::json to_json(const ClockResponse& value);
nlohmann::json to_json(const Acknowledge& value);
nlohmann::json to_json(const PoseEstimate& value);
nlohmann::json to_json(const VideoFrame& value);
nlohmann::json to_json(const Mask& value);
nlohmann::json to_json(const FrameDone& value);
nlohmann::json to_json(const Message& value);

template <class T>
[[nodiscard]] Result<T> from_json(const nlohmann::json& json);

// The same by text: no need to include json. One line.
template <class T>
std::string to_json_text(const T& value);

template <class T>
[[nodiscard]] Result<T> from_json_text(std::string_view text);

}  // namespace counterpart
