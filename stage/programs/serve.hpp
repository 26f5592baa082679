// `stage serve`: a camera over our own protocol, and the real player who watches the game on the same link.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "protocol/transport/endpoint.hpp"
#include "protocol/vocabulary/result.hpp"
#include "stage/film/film.hpp"

namespace counterpart::stage {

struct ServeOptions {
  std::string listen = "127.0.0.1:7403";
  std::string scenario;
  std::uint64_t frames = 0;
  std::string truth;
  std::string token_file, tls_file;
  std::optional<std::uint64_t> seed;
  bool lockstep = false;
};

[[nodiscard]] Result<void> run_serve(const ServeOptions& options, const std::function<bool()>& stop_requested);

// The same on a link that is already there. Sends INTRINSICS and the current frame to everyone who joins; lockstep: the
// next frame when a peer reports FRAME_DONE for the last, otherwise by the clock. Ends after options.frames with BYE.
[[nodiscard]] Result<void> serve_film(Film& film, Endpoint& endpoint, const ServeOptions& options,
                                      const std::function<bool()>& stop_requested);

}  // namespace counterpart::stage
