#include "vhd_renderer/voice/wav.hpp"

#include <algorithm>

namespace counterpart {
namespace {

std::uint32_t little_endian(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return value;
}

void append(std::string& bytes, std::uint32_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
}

}  // namespace

Result<Sound> decode_wav(const std::string& bytes) {
  const auto wrong = [](const char* what) { return failure(ErrorCode::bad_format, std::string("WAV: ") + what); };
  if (bytes.size() < 12 || bytes.compare(0, 4, "RIFF") != 0 || bytes.compare(8, 4, "WAVE") != 0) {
    return wrong("this is none");
  }
  Sound sound;
  bool described = false;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::size_t left = bytes.size() - at - 8;
    const std::size_t size = std::min<std::size_t>(little_endian(bytes, at + 4, 4), left);
    if (bytes.compare(at, 4, "fmt ") == 0) {
      if (size < 16) return wrong("its description is cut");
      const bool plain = little_endian(bytes, at + 8, 2) == 1 && little_endian(bytes, at + 10, 2) == 1 &&
                         little_endian(bytes, at + 22, 2) == 16;
      sound.rate_hz = static_cast<int>(little_endian(bytes, at + 12, 4));
      if (!plain || sound.rate_hz < 4000 || sound.rate_hz > 192000) return wrong("not one channel of 16 bits");
      described = true;
    } else if (bytes.compare(at, 4, "data") == 0) {
      if (!described) return wrong("samples before their description");
      for (std::size_t i = 0; i + 2 <= size; i += 2) {
        sound.samples.push_back(static_cast<std::int16_t>(little_endian(bytes, at + 8 + i, 2)));
      }
      return sound;
    }
    at += 8 + size + size % 2;
  }
  return wrong("it holds no samples");
}

std::string encode_wav(const Sound& sound) {
  const auto rate = static_cast<std::uint32_t>(sound.rate_hz);
  const auto size = static_cast<std::uint32_t>(2 * sound.samples.size());
  std::string bytes("RIFF");
  append(bytes, 36 + size, 4);
  bytes += "WAVEfmt ";
  append(bytes, 16, 4);
  append(bytes, 1, 2);  // plain samples
  append(bytes, 1, 2);  // one channel
  append(bytes, rate, 4);
  append(bytes, 2 * rate, 4);
  append(bytes, 2, 2);
  append(bytes, 16, 2);
  bytes += "data";
  append(bytes, size, 4);
  for (const std::int16_t sample : sound.samples) append(bytes, static_cast<std::uint16_t>(sample), 2);
  return bytes;
}

}  // namespace counterpart
