#include "vhd_renderer/voice/espeak.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

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
  EXPECT_EQ(espeak_speaker("", Speaking::at_once)("hello", "no language").get(), nullptr);
}

// A program that speaks when somebody writes into a pipe, and not before.
class SlowVoice : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("slow_voice_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    pipe_ = folder_ / "go";
    ASSERT_EQ(::mkfifo(pipe_.c_str(), 0600), 0);
    program_ = folder_ / "voice";
    std::ofstream(program_) << "#!/bin/sh\nread word < " << pipe_.string() << "\n"
                            << R"(printf 'RIFF\054\000\000\000WAVEfmt \020\000\000\000\001\000\001\000')"
                            << "\n"
                            << R"(printf '\042\126\000\000\104\254\000\000\002\000\020\000data\010\000\000\000')"
                            << "\n"
                            << R"(printf '\001\002\001\002\001\002\001\002')"
                            << "\n";
    std::filesystem::permissions(program_, std::filesystem::perms::owner_all);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_, pipe_, program_;
};

TEST_F(SlowVoice, IsNotWaitedForInTheBackground) {
  const Speaker speaker = espeak_speaker("", Speaking::in_the_background, program_.string());
  const SoundToCome first = speaker("one", "en");
  const SoundToCome second = speaker("two", "en");
  EXPECT_EQ(first.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
  std::ofstream(pipe_) << "go\n";
  ASSERT_NE(first.get(), nullptr);
  EXPECT_EQ(first.get()->samples.size(), 4U);
  std::ofstream(pipe_) << "go\n";
  ASSERT_NE(second.get(), nullptr);
  EXPECT_NE(speaker("one", "en").get(), nullptr) << "remembered: nobody writes into the pipe now";
}

TEST_F(SlowVoice, GoesWhenNobodyListensAnyMore) {
  SoundToCome never;
  {
    const Speaker speaker = espeak_speaker("", Speaking::in_the_background, program_.string());
    never = speaker("one", "en");
    speaker("two", "en");
  }
  // The sentence in work ended without a sound, long before its five seconds; the other was never begun.
  EXPECT_EQ(never.wait_for(std::chrono::seconds(0)), std::future_status::ready);
}

}  // namespace
}  // namespace counterpart
