#include "vhd_renderer/voice/espeak.hpp"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

TEST(Espeak, SpeaksASentence) {
  const auto sound = speak("It is your move.", "en");
  if (!sound && sound.error().message.find("install") != std::string::npos) {
    GTEST_SKIP() << sound.error().message;
  }
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_GT(sound->duration_s(), 0.5);
  EXPECT_LT(sound->duration_s(), 3);
  const auto [low, high] = std::minmax_element(sound->samples.begin(), sound->samples.end());
  EXPECT_GT(*high - *low, 5000) << "it can be heard";
  const auto more = speak("It is your move. Please take your time, there is no clock.", "en");
  ASSERT_TRUE(more);
  EXPECT_GT(more->duration_s(), 1.5 * sound->duration_s());
}

TEST(Espeak, SaysWhatIsMissingAndTakesNoOptionsFromStrangers) {
  const auto absent = speak("hello", "en", "", "no-such-espeak");
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message.find("espeak-ng"), std::string::npos) << absent.error().message;
  EXPECT_FALSE(speak("hello", "../../etc/passwd"));
  EXPECT_FALSE(speak("hello", ""));
  EXPECT_FALSE(speak(std::string(5000, 'a'), "en"));
  EXPECT_EQ(espeak_speaker("")("hello", "no language"), nullptr);
}

}  // namespace
}  // namespace counterpart
