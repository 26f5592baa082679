// Those who listen to the tracker: renderers, observers, directors. Sends each what it needs and gathers what they say.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "protocol/session/command_relay.hpp"
#include "protocol/transport/endpoint.hpp"
#include "tracker_server/camera/camera.hpp"

namespace counterpart {

struct Heard {
  std::vector<Feedback> feedback;  // of the primary renderer, to commands of the game
  std::vector<Control> controls;
  bool renderer_joined = false;  // a fresh primary renderer
};

// One renderer is the primary, which answers commands; the others get the same stream and are not asked.
class Audience {
 public:
  explicit Audience(std::unique_ptr<Endpoint> link);
  ~Audience();

  void hear(std::int64_t timeout_ns);
  Heard take_heard();

  bool has_renderer() const { return primary_.has_value(); }
  bool fresh_renderer() const { return heard_.renderer_joined; }
  bool composited(FrameId frame) const { return composited_ && *composited_ >= frame; }

  void broadcast(const Message& message);
  // Sent to all when they change, and to everybody who joins later.
  void show_snapshot(const Message& message);
  void order(const Command& command);
  void show(const Frame& frame);
  // Waits up to a second for the peers to have heard it.
  void say_goodbye(const std::string& reason);

  std::string address() const;
  nlohmann::json report() const;

 private:
  void join(const PeerJoined& joined);
  void leave(const PeerLeft& left);
  void receive(PeerId peer, const Message& message);
  void relay_order(PeerId director, const Command& command);
  void relay_feedback(const Feedback& feedback);

  std::unique_ptr<Endpoint> link_;
  std::map<PeerId, Role> peers_;
  std::optional<PeerId> primary_;
  std::optional<FrameId> composited_;
  std::map<MessageType, Message> snapshots_;
  CommandRelay relay_;
  Heard heard_;
};

}  // namespace counterpart
