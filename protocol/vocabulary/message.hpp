// Every message of the protocol, version 1. docs/protocol.md is the page this file follows.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "protocol/vocabulary/command.hpp"
#include "protocol/vocabulary/game.hpp"
#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/pose.hpp"
#include "protocol/vocabulary/scene.hpp"
#include "protocol/vocabulary/video.hpp"

namespace counterpart {

// Numbers are for ever: a type is never reused or renumbered.
enum class MessageType : std::uint16_t {
  hello = 1,
  welcome = 2,
  heartbeat = 3,
  error = 4,
  bye = 5,
  clock_request = 6,
  clock_response = 7,
  acknowledge = 8,
  challenge = 9,
  proof = 10,
  intrinsics = 16,
  pose = 17,
  video = 18,
  mask = 19,
  debug = 20,
  frame_done = 21,
  board_state = 32,
  game_event = 33,
  control = 34,
  scene = 35,
  command = 48,
  feedback = 49,
};

enum class Role : std::uint8_t {
  camera = 1,    // gives frames (the stage, a third host)
  tracker = 2,   // tracker_server: gives poses, game and commands
  renderer = 3,  // vhd_renderer: answers commands
  observer = 4,  // receives the stream, answers nothing
  director = 5,  // vhp send / script: gives commands and controls
};

struct Hello {
  std::uint8_t version_min = 1;
  std::uint8_t version_max = 1;
  Role role = Role::observer;
  std::string software;              // name and version, for people
  std::uint64_t resume_session = 0;  // 0: a new session
  std::uint64_t last_seq = 0;        // of the kept messages of the resumed session, the last one received
  bool video = false;                // this connection carries VIDEO for resume_session, nothing else
  bool want_video = false;           // a second connection for VIDEO will follow
  bool lockstep = false;             // no frame dropped; FRAME_DONE paces the camera
  bool h264 = false;                 // pictures may come in H.264, besides raw and JPEG
  bool want_debug = false;           // DEBUG is sent

  friend bool operator==(const Hello&, const Hello&) = default;
};

struct Welcome {
  std::uint8_t version = 1;
  std::uint64_t session = 0;
  Role role = Role::tracker;
  std::string software;
  bool resumed = false;
  std::uint64_t last_seq = 0;
  bool lockstep = false;

  friend bool operator==(const Welcome&, const Welcome&) = default;
};

struct Heartbeat {
  std::uint32_t queued = 0;   // messages waiting to be sent
  std::uint64_t dropped = 0;  // latest-wins messages replaced before they were sent, since the start

  friend bool operator==(const Heartbeat&, const Heartbeat&) = default;
};

struct ErrorReport {
  std::uint16_t code = 0;  // an ErrorCode
  std::string message;

  friend bool operator==(const ErrorReport&, const ErrorReport&) = default;
};

struct Bye {
  std::string reason;

  friend bool operator==(const Bye&, const Bye&) = default;
};

struct ClockRequest {
  std::int64_t sent_ns = 0;  // on the asker's monotonic clock

  friend bool operator==(const ClockRequest&, const ClockRequest&) = default;
};

struct ClockResponse {
  std::int64_t sent_ns = 0;      // the request's
  std::int64_t received_ns = 0;  // on the answerer's monotonic clock
  std::int64_t answered_ns = 0;

  friend bool operator==(const ClockResponse&, const ClockResponse&) = default;
};

// All kept messages up to and with this sequence number have arrived.
struct Acknowledge {
  std::uint64_t seq = 0;

  friend bool operator==(const Acknowledge&, const Acknowledge&) = default;
};

using Bytes32 = std::array<std::uint8_t, 32>;

// A server that has a token asks the client to prove that it has it, too.
struct Challenge {
  Bytes32 nonce{};

  friend bool operator==(const Challenge&, const Challenge&) = default;
};

struct Proof {
  Bytes32 nonce{};
  Bytes32 mac{};  // HMAC-SHA256, see docs/protocol.md section 5

  friend bool operator==(const Proof&, const Proof&) = default;
};

struct FrameDone {
  FrameStamp stamp;

  friend bool operator==(const FrameDone&, const FrameDone&) = default;
};

// What the tracker saw in one frame; sent only to those who ask.
struct DebugPoint {
  float x = 0, y = 0;        // pixels
  std::uint8_t verdict = 0;  // tracker_server/edges names them; 1 = accepted

  friend bool operator==(const DebugPoint&, const DebugPoint&) = default;
};

struct DebugView {
  FrameStamp stamp;
  std::vector<std::array<float, 4>> lines;  // projected model, x0 y0 x1 y1
  std::vector<DebugPoint> points;
  std::string readings;  // one letter a cell, by rows: e d l p ?

  friend bool operator==(const DebugView&, const DebugView&) = default;
};

using Message = std::variant<Hello, Welcome, Heartbeat, ErrorReport, Bye, ClockRequest, ClockResponse, Acknowledge,
                             Intrinsics, PoseEstimate, VideoFrame, Mask, DebugView, FrameDone, BoardState, GameEvent,
                             Control, Scene, Command, Feedback, Challenge, Proof>;

MessageType type_of(const Message& message);

// Kept messages are acknowledged, resent after a reconnect and delivered once; the others are latest-wins.
bool is_kept(MessageType type);

}  // namespace counterpart
