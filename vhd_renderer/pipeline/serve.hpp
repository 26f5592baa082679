// The daemon: frame and pose in pairs → director → draw → composite → mirror; answers the tracker's commands.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/transport/endpoint.hpp"
#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/composite/composite.hpp"

namespace counterpart {

struct RendererOptions {
  std::string tracker = "127.0.0.1:7401";
  std::string listen;  // HOST:PORT for directors who command the human without a tracker; empty: none
  LinkOptions link;
  std::string character = "default";  // name of a character, a GLB file, or "mannequin"
  std::string clips;                  // folder with more clips; empty: those made here
  std::vector<std::string> outputs;   // FILE.mp4 or a folder
  std::string web;                    // HOST:PORT of the mirror page; empty: none
  CompositeOptions composite;
  bool lockstep = false;
  std::int64_t patience_ns = 0;  // fail if no tracker answers for so long at the start; 0: wait for ever
  std::string report_file;
};

// Returns when the tracker says goodbye, or a stop signal came.
[[nodiscard]] Result<void> serve(const RendererOptions& options);

}  // namespace counterpart
