#include "vhd_renderer/voice/wav.hpp"

#include <gtest/gtest.h>

namespace counterpart {
namespace {

TEST(Wav, ReadsBackWhatWasWritten) {
  const Sound sound{16000, {0, 1, -1, 32767, -32768}};
  const auto read = decode_wav(encode_wav(sound));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rate_hz, 16000);
  EXPECT_EQ(read->samples, sound.samples);
}

TEST(Wav, IsRefusedWhereItIsCut) {
  std::string wav(
      "RIFF\xff\xff\xff\x7fWAVEfmt \x10\0\0\0\1\0\1\0\x22\x56\0\0\x44\xac\0\0\2\0\x10\0data\xff\xff\xff\x7f", 44);
  wav += std::string("\1\0\2\0\3\0", 6);
  const auto sound = decode_wav(wav);
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_EQ(sound->rate_hz, 22050);
  EXPECT_EQ(sound->samples, (std::vector<std::int16_t>{1, 2, 3}));
  for (std::size_t size = 0; size < 44; ++size) {
    EXPECT_FALSE(decode_wav(wav.substr(0, size))) << size;
  }
  std::string stereo = wav;
  stereo[22] = 2;
  EXPECT_FALSE(decode_wav(stereo));
}

}  // namespace
}  // namespace counterpart
