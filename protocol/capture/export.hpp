// Captures for other programs.
#pragma once

#include <iosfwd>

#include "protocol/capture/session_reader.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// A line a pose: frame,t_ns,object,tx,ty,tz,qw,qx,qy,qz,status,rms_px (x_cam = R x_board + t). Returns how many.
std::uint64_t export_csv(SessionReader& reader, std::ostream& out);

// Every game as PDN 3.0. Returns how many.
std::uint64_t export_pdn(SessionReader& reader, std::ostream& out);

// A JSON object a line for every pose of the board, after SMPTE RIS OpenTrackIO 1.0: the camera in the board frame,
// metres and degrees, rotation as pan about z, then tilt about x, then roll about y. Returns how many.
std::uint64_t export_opentrackio(SessionReader& reader, std::ostream& out);

}  // namespace counterpart
