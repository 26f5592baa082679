// Frames over our own protocol: the stage, a camera on a third host, a capture being replayed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "protocol/vocabulary/result.hpp"
#include "tracker_server/camera/camera.hpp"

namespace counterpart {

class Endpoint;

// host_port: "127.0.0.1:7403". Waits wait_ns for the camera host to answer. Survives a lost link: frames go on when the
// host is back. Ends when the host says BYE.
[[nodiscard]] Result<std::unique_ptr<Camera>> open_vhp_camera(const std::string& host_port, Pace pace,
                                                              const CameraAccess& access, std::int64_t wait_ns);

// The same over any link, for tests.
[[nodiscard]] std::unique_ptr<Camera> make_vhp_camera(std::unique_ptr<Endpoint> link, Pace pace);

}  // namespace counterpart
