// The mirror in a browser: the picture, the board, what happens in words, and the buttons of a game.
//
//   GET  /             the page, which needs nothing from outside
//   GET  /stream.mjpg  the picture, as it changes (multipart/x-mixed-replace)
//   GET  /frame.jpg    the picture as it is now
//   GET  /speech.wav   what was said last, if it can be heard; its number stands in the state as "speech"
//   GET  /state.json   everything else that is known, as JSON
//   GET  /events       the same as Server-Sent Events, again with every change
//   POST /control      a Control as JSON (docs/protocol.md, section 2), its id may be left out
//
// Whoever watches slowly gets fewer pictures; nothing is kept for him. The work is done on a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "protocol/vocabulary/command.hpp"
#include "protocol/vocabulary/game.hpp"
#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/video.hpp"
#include "vhd_renderer/voice/sound.hpp"

namespace counterpart {

struct MirrorStatus {
  double fps = 0;
  std::uint64_t frames = 0;
  std::uint64_t dropped = 0;
  bool tracker_connected = false;
  std::string tracking;       // "ok", "coasting", "lost", "relocalised"; empty: not known
  double round_trip_ms = -1;  // of the link to the tracker; -1: not known
};

class WebMirror {
 public:
  // address: "HOST:PORT"; port 0 takes a free one. Anyone who reaches it may watch and play: loopback unless the user
  // says otherwise.
  [[nodiscard]] static Result<std::unique_ptr<WebMirror>> listen(const std::string& address);
  ~WebMirror();
  WebMirror(const WebMirror&) = delete;
  WebMirror& operator=(const WebMirror&) = delete;

  // The newest picture, raw or JPEG. A raw one is compressed only if somebody watches.
  void show(VideoFrame picture);
  bool watched() const;

  void say(const BoardState& state);
  void event(const GameEvent& event);
  void feedback(const Feedback& feedback);
  void subtitle(const std::string& text);                  // empty: nothing is being said
  void speech(const std::shared_ptr<const Sound>& sound);  // what is being heard; null: nothing
  void status(const MirrorStatus& status);

  // What people asked for since the last call, in order.
  std::vector<Control> take_controls();

  // host:port that is listened on.
  std::string address() const;

 private:
  class Server;
  explicit WebMirror(std::unique_ptr<Server> server);
  std::unique_ptr<Server> server_;
};

}  // namespace counterpart
