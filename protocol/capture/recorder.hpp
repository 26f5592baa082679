// Captures everything that goes through a hub: docs/protocol.md, section 7. The file is written on a thread of its own.
#pragma once

#include <memory>
#include <string>

#include "protocol/session/hub.hpp"

namespace counterpart {

class Recorder : public WireTap {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> open(const std::string& path, Role role,
                                                              const std::string& software);
  // Writes what is left, the summary and the footer.
  ~Recorder() override;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void saw(bool incoming, bool video_lane, PeerId peer, const HeaderBytes& header, ByteView body,
           std::int64_t now_ns) override;

  // The first trouble (a full disk, a disk that is too slow), once.
  std::optional<Error> take_error() override;

 private:
  struct State;
  explicit Recorder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace counterpart
