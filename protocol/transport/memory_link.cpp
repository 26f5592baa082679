#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>

#include "protocol/session/hub.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/transport/outgoing.hpp"

namespace counterpart {
namespace {

// Nothing ticks while neither program calls, so nobody may be declared dead for silence.
LinkOptions without_deadlines(LinkOptions options) {
  options.dead_after_ns = std::numeric_limits<std::int64_t>::max() / 4;
  return options;
}

// Two hubs in one process; whoever calls carries the bytes for both.
class MemoryPipe {
 public:
  MemoryPipe(const LinkOptions& a, const LinkOptions& b)
      : server_(Hub::End::server, without_deadlines(a), ""), client_(Hub::End::client, without_deadlines(b), "") {
    const std::lock_guard lock(mutex);
    pump();
  }

  // Moves bytes until nothing moves any more. Call with the mutex held.
  void pump() {
    while (const auto lane = client_.wants_to_dial(monotonic_ns())) {
      const auto accepted = server_.accepted(monotonic_ns());
      if (!accepted) break;
      wires_.push_back({*accepted, client_.dialled(*lane, monotonic_ns()), {}, {}});
    }
    server_.tick(monotonic_ns());
    client_.tick(monotonic_ns());
    bool moved = true;
    while (moved) {
      moved = false;
      for (Wire& wire : wires_) {
        moved |= carry(server_, wire.server, client_, wire.client, wire.to_client);
        moved |= carry(client_, wire.client, server_, wire.server, wire.to_server);
      }
      if (const auto lane = client_.wants_to_dial(monotonic_ns())) {
        wires_.push_back({*server_.accepted(monotonic_ns()), client_.dialled(*lane, monotonic_ns()), {}, {}});
        moved = true;
      }
    }
    drop_finished();
    changed.notify_all();
  }

  void leave(Hub& hub) {
    hub.leave(monotonic_ns());
    pump();
  }

  Hub& server() { return server_; }
  Hub& client() { return client_; }

  std::mutex mutex;
  std::condition_variable changed;

 private:
  struct Wire {
    ConnectionId server = 0, client = 0;
    Bytes to_client, to_server;  // written and not read yet
  };

  static bool carry(Hub& from, ConnectionId out, Hub& to, ConnectionId in, Bytes& pending) {
    bool moved = false;
    while (pending.size() < kMostPending) {
      const auto message = from.next_to_write(out, monotonic_ns());
      if (!message) break;
      pending.insert(pending.end(), message->header.begin(), message->header.end());
      pending.insert(pending.end(), message->body->begin(), message->body->end());
      moved = true;
    }
    std::size_t done = 0;
    while (done < pending.size() && to.wants_read(in)) {
      const auto room = to.parser(in).room();
      const std::size_t count = std::min(room.size(), pending.size() - done);
      std::memcpy(room.data(), pending.data() + done, count);
      to.read(in, count, monotonic_ns());
      done += count;
    }
    pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(done));
    return moved || done > 0;
  }

  void drop_finished() {
    const Error over{ErrorCode::closed, "the other end is gone"};
    for (Wire& wire : wires_) {
      if (!server_.finished(wire.server) && !client_.finished(wire.client)) continue;
      server_.closed(wire.server, over, monotonic_ns());
      client_.closed(wire.client, over, monotonic_ns());
    }
    wires_.erase(
        std::remove_if(wires_.begin(), wires_.end(), [&](const Wire& wire) { return !server_.exists(wire.server); }),
        wires_.end());
  }

  static constexpr std::size_t kMostPending = 32U << 20;

  Hub server_, client_;
  std::vector<Wire> wires_;
};

class MemoryEndpoint : public Endpoint {
 public:
  MemoryEndpoint(std::shared_ptr<MemoryPipe> pipe, Hub& hub, LinkOptions options, std::string name)
      : pipe_(std::move(pipe)), hub_(hub), options_(std::move(options)), name_(std::move(name)) {}

  ~MemoryEndpoint() override {
    const std::lock_guard lock(pipe_->mutex);
    pipe_->leave(hub_);
  }

  MemoryEndpoint(const MemoryEndpoint&) = delete;
  MemoryEndpoint& operator=(const MemoryEndpoint&) = delete;

  void send(PeerId peer, const Message& message) override {
    const auto outgoing = make_outgoing(message, {options_.video_codec.value_or(PixelCodec::raw_bgr8)});
    const std::lock_guard lock(pipe_->mutex);
    if (outgoing) {
      hub_.send(peer, *outgoing, monotonic_ns());
    } else {
      hub_.report(peer, outgoing.error(), monotonic_ns());
    }
    pipe_->pump();
  }

  void broadcast(const Message& message) override {
    const auto outgoing = make_outgoing(message, {options_.video_codec.value_or(PixelCodec::raw_bgr8)});
    const std::lock_guard lock(pipe_->mutex);
    if (outgoing) {
      hub_.broadcast(*outgoing, monotonic_ns());
    } else {
      hub_.report(0, outgoing.error(), monotonic_ns());
    }
    pipe_->pump();
  }

  std::vector<Inbound> receive(std::int64_t timeout_ns) override {
    std::unique_lock lock(pipe_->mutex);
    if (!hub_.has_inbound()) pipe_->pump();
    if (timeout_ns > 0) {
      pipe_->changed.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [&] { return hub_.has_inbound(); });
    }
    auto taken = hub_.take_inbound();
    pipe_->pump();
    return taken;
  }

  std::vector<PeerStats> stats() const override {
    const std::lock_guard lock(pipe_->mutex);
    return hub_.stats(monotonic_ns());
  }

  std::string address() const override { return name_; }

 private:
  std::shared_ptr<MemoryPipe> pipe_;
  Hub& hub_;
  LinkOptions options_;
  std::string name_;
};

}  // namespace

std::pair<std::unique_ptr<Endpoint>, std::unique_ptr<Endpoint>> memory_link(const LinkOptions& a,
                                                                            const LinkOptions& b) {
  const auto pipe = std::make_shared<MemoryPipe>(a, b);
  return {std::make_unique<MemoryEndpoint>(pipe, pipe->server(), a, "memory:a"),
          std::make_unique<MemoryEndpoint>(pipe, pipe->client(), b, "memory:b")};
}

}  // namespace counterpart
