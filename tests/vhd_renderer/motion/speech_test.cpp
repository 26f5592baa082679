#include "vhd_renderer/motion/speech.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/vhd_renderer/motion/rehearsal.hpp"

namespace counterpart {
namespace {

// Two words as far as anybody can hear: half a second of tone, a pause of 0.6 s, half a second of tone.
Sound two_tones() {
  Sound sound;
  for (int i = 0; i < sound.rate_hz * 8 / 5; ++i) {
    const double t = static_cast<double>(i) / sound.rate_hz;
    const bool heard = t < 0.5 || t > 1.1;
    sound.samples.push_back(static_cast<std::int16_t>(heard ? 9000 * std::sin(6.28 * 200 * t) : 0));
  }
  return sound;
}

TEST(Utterance, OpensTheMouthWhileThereIsSomethingToHear) {
  const Sound sound = two_tones();
  const Utterance said("aaaa aaaa", &sound);
  EXPECT_GT(said.at(0.25).open, 0.4F);
  EXPECT_LT(said.at(0.8).open, 0.02F) << "shut in the pause";
  EXPECT_GT(said.at(1.35).open, 0.4F);
  EXPECT_LT(said.at(1.75).open, 0.02F);
  EXPECT_NEAR(said.duration_s(), 1.7, 0.01);
}

TEST(Utterance, SharesTheLettersOutOverWhatIsHeard) {
  const Sound sound = two_tones();
  const Utterance said("aaaa mmmm", &sound);
  EXPECT_GT(said.at(0.25).open, 0.4F) << "the first word";
  EXPECT_GT(said.at(1.35).press, 0.4F) << "lips together in the second";
  EXPECT_LT(said.at(1.35).open, 0.1F);
}

TEST(Utterance, MovesTheMouthWithoutASoundToo) {
  const Utterance said("Good evening. Your move.");
  float widest = 0;
  for (double t = 0; t < said.duration_s(); t += 0.04) widest = std::max(widest, said.at(t).open);
  EXPECT_GT(widest, 0.25F);
  const Sound silence{22050, std::vector<std::int16_t>(22050, 0)};
  EXPECT_GE(Utterance("x", &silence).duration_s(), 1.2) << "silence is no reason to fail";
}

TEST(Director, SaysForAsLongAsTheSoundLastsAndIsSilencedByStop) {
  const auto sound = std::make_shared<Sound>(two_tones());
  const Figure figure = mannequin();
  Director director(figure, [&](const std::string&, const std::string& language) {
    return ready_sound(language == "en" ? sound : nullptr);
  });
  DirectorInputs in;
  Command say;
  say.id = 1;
  say.action = Say{"aaaa aaaa", "en", ""};
  in.commands = {say};
  int heard = 0;
  std::string last_state;
  for (int i = 0; i < 60; ++i) {
    const Performance p = director.step(in);
    in.commands.clear();
    in.now_ns += frame_ns;
    if (p.sound != nullptr) {
      EXPECT_NEAR(p.sound_s, 0.04 * heard, 0.001) << "the sound goes on with the frames";
      ++heard;
    }
  }
  EXPECT_NEAR(heard * 0.04, 1.7, 0.09);
  say.id = 2;
  in.commands = {say};
  EXPECT_NE(director.step(in).sound, nullptr);
  in.now_ns += frame_ns;
  in.commands.front() = Command{};
  in.commands.front().id = 3;  // stop everything
  EXPECT_EQ(director.step(in).sound, nullptr);
}

TEST(Director, GoesOnWhileTheVoiceIsStillMakingItsSound) {
  const auto sound = std::make_shared<Sound>(two_tones());
  const Figure figure = mannequin();
  std::promise<std::shared_ptr<const Sound>> promise;
  const SoundToCome to_come = promise.get_future().share();
  Director director(figure, [&](const std::string&, const std::string&) { return to_come; });
  DirectorInputs in;
  Command say;
  say.id = 1;
  say.action = Say{"aaaa aaaa", "en", ""};
  in.commands = {say};
  const auto step = [&] {
    const Performance p = director.step(in);
    in.commands.clear();
    in.now_ns += frame_ns;
    return p;
  };
  for (int i = 0; i < 10; ++i) {
    const Performance p = step();
    EXPECT_EQ(p.sound, nullptr);
    EXPECT_EQ(p.subtitle, "aaaa aaaa") << "it can be read before it is heard";
  }
  promise.set_value(sound);
  const Performance heard = step();
  EXPECT_EQ(heard.sound, sound);
  EXPECT_EQ(heard.sound_s, 0) << "from its beginning";
  FeedbackState last = FeedbackState::started;
  int frames = 0;
  for (; !is_final(last) && frames < 100; ++frames) {
    for (const Feedback& f : step().feedback) last = f.state;
  }
  EXPECT_EQ(last, FeedbackState::finished);
  EXPECT_NEAR(frames * 0.04, 1.7, 0.09);
}

TEST(Director, DoesNotWaitForAVoiceForEver) {
  const Figure figure = mannequin();
  std::promise<std::shared_ptr<const Sound>> never;
  const SoundToCome to_come = never.get_future().share();
  Director director(figure, [&](const std::string&, const std::string&) { return to_come; });
  DirectorInputs in;
  Command say;
  say.id = 1;
  say.action = Say{"Your move.", "en", ""};
  in.commands = {say};
  FeedbackState last = FeedbackState::accepted;
  for (int i = 0; i < 120 && !is_final(last); ++i) {
    for (const Feedback& f : director.step(in).feedback) last = f.state;
    in.commands.clear();
    in.now_ns += frame_ns;
  }
  EXPECT_EQ(last, FeedbackState::finished) << "the words were shown for as long as it takes to read them";
}

}  // namespace
}  // namespace counterpart
