// Any file as one that people write by hand: a board's sizes, a camera, a starting pose, a scenario of the stage. No
// crash.
#include <cstdio>
#include <string>

#include <unistd.h>

#include "stage/scenario/scenario.hpp"
#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/pipeline/board_file.hpp"
#include "tracker_server/pose/start_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  if (size < 1) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 4 == 3) {
    static_cast<void>(stage::parse_scenario(text));
    return 0;
  }
  static const std::string path = "/tmp/counterpart_config_fuzz_" + std::to_string(getpid());
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return 0;
  std::fwrite(text.data(), 1, text.size(), file);
  std::fclose(file);
  if (data[0] % 4 == 0) static_cast<void>(read_board_file(path));
  if (data[0] % 4 == 1) static_cast<void>(read_camera_json(path));
  if (data[0] % 4 == 2) static_cast<void>(read_start_file(path));
  return 0;
}
