// Any file: no crash, no message that reaches beyond it.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <unistd.h>

#include "protocol/capture/session_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  static const std::string path = "/tmp/counterpart_mcap_fuzz_" + std::to_string(getpid());
  FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return 0;
  std::fwrite(data, 1, size, file);
  std::fclose(file);
  std::size_t bytes = 0;
  if (auto reader = McapReader::open(path)) {
    while (const auto message = (*reader)->next()) bytes += message->data.size();
  }
  if (bytes > size) std::abort();
  if (auto reader = SessionReader::open(path)) {
    while ((*reader)->next()) {
    }
  }
  std::remove(path.c_str());
  return 0;
}
