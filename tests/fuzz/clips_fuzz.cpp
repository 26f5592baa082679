// Any file as a clip: no crash, and one that was understood can be played.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include <unistd.h>

#include "vhd_renderer/motion/clip_file.hpp"

namespace {

const char* kind_of(std::string_view bytes) {
  if (bytes.rfind("glTF", 0) == 0) return ".glb";
  if (bytes.rfind("HIERARCHY", 0) == 0) return ".bvh";
  return bytes.find("\"asset\"") != std::string_view::npos ? ".gltf" : ".json";
}

}  // namespace

// assimp leaks what it has read of a file that it then refuses; a program reads its clips once.
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  const std::string path =
      "/tmp/counterpart_clips_fuzz_" + std::to_string(getpid()) + kind_of({reinterpret_cast<const char*>(data), size});
  FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return 0;
  std::fwrite(data, 1, size, file);
  std::fclose(file);
  if (const auto clip = read_clip_file(path)) {
    if (!(clip->seconds > 0)) std::abort();
    BodyControls body;
    ArmGoal hand;
    for (int i = 0; i <= 10; ++i) {
      const float t = clip->seconds * static_cast<float>(i) / 10;
      add_clip(*clip, t, 1, ~0U, body, {});
      clip_hand(*clip, t, right_side, {}, hand, {});
      if (!std::isfinite(body.spine.pitch) || !hand.wrist_S.allFinite()) std::abort();
    }
  }
  std::remove(path.c_str());
  return 0;
}
