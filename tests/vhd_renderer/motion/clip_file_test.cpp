#include "vhd_renderer/motion/clip_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/vhd_renderer/motion/human_measures.hpp"
#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

const fs::path data = fs::path(COUNTERPART_SOURCE_DIR) / "tests" / "data" / "clips";

std::string bytes_of(const fs::path& path) {
  std::stringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

// A folder of its own for a test's files.
class ClipFolder : public testing::Test {
 protected:
  ClipFolder()
      : folder_(fs::temp_directory_path() / ("clips_" + std::to_string(::getpid()) + "_" +
                                             testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~ClipFolder() override { fs::remove_all(folder_); }

  fs::path put(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  fs::path folder_;
};

class EitherFile : public testing::TestWithParam<const char*> {};

// The script that made the files says what moves how far (tests/data/clips/make_clips).
TEST_P(EitherFile, IsReadAsTheMotionItHolds) {
  const auto clip = read_clip_file(data / GetParam());
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_NEAR(clip->seconds, 2.0F, 0.04F);
  float lowest = 0;
  for (const auto& [time_s, turn] : clip->head) {
    lowest = std::max(lowest, turn.pitch);
    EXPECT_NEAR(turn.yaw, 0, 0.01F);
    EXPECT_NEAR(turn.roll, 0, 0.01F);
  }
  EXPECT_NEAR(lowest, radians(20), radians(0.5F)) << "he bows his head";
  EXPECT_NEAR(clip->head.front().second.pitch, 0, 1e-4F);
  EXPECT_NEAR(clip->head.back().second.pitch, 0, 1e-4F);
  const auto hand_at = [&](std::size_t side, float t) {
    const auto& keys = clip->hand[side];
    return std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.first >= t; })->second;
  };
  EXPECT_GT(hand_at(right_side, 1.0F).place.z(), 0.35F) << "the right hand is over the shoulders";
  EXPECT_LT(hand_at(left_side, 1.0F).place.z(), -0.6F) << "the left one hangs";
  EXPECT_GT(hand_at(right_side, 1.0F).place.x(), 0.3F) << "on his right";
  EXPECT_NEAR(hand_at(left_side, 0.0F).place.x(), -hand_at(right_side, 0.0F).place.x(), 0.01F);
  const Eigen::Vector3f fingers = hand_at(left_side, 1.0F).rotation * Eigen::Vector3f::UnitX();
  EXPECT_LT(fingers.z(), -0.9F) << "the fingers of the hanging hand point down";
}

INSTANTIATE_TEST_SUITE_P(ClipFile, EitherFile, testing::Values("greet_bvh.bvh", "greet_gltf.gltf"));

TEST(ClipFile, SaysTheSameInBothForms) {
  const Clip a = read_clip_file(data / "greet_bvh.bvh").value();
  const Clip b = read_clip_file(data / "greet_gltf.gltf").value();
  ASSERT_EQ(a.head.size(), b.head.size());
  for (std::size_t i = 0; i < a.head.size(); ++i) {
    EXPECT_NEAR(a.head[i].second.pitch, b.head[i].second.pitch, 0.02F);
    EXPECT_LT((a.hand[right_side][i].second.place - b.hand[right_side][i].second.place).norm(), 0.03F) << i;
  }
}

TEST(ClipFile, IsPlayedByABodyThatStaysABody) {
  const ClipLibrary clips = clips_with_folder(data).value();
  Rehearsal r(mannequin(), clips);
  PoseJudge judge(r.figure);
  r.take_seat("instant");
  for (std::uint64_t id = 1; const char* name : {"greet_bvh", "greet_gltf"}) {
    Command c;
    c.id = id++;
    c.action = Keyframe{name, 1, 1, BodyPart::whole, false};
    r.frame({c});
    float highest = -1;
    for (int i = 0; i < 100 && !r.ended(c.id); ++i) {
      r.frame();
      judge.look(r.last, name);
      highest = std::max(highest, r.joint("r_wrist").z() - r.joint("r_shoulder").z());
    }
    EXPECT_EQ(r.said[c.id].back().state, FeedbackState::finished) << r.said[c.id].back().code;
    EXPECT_GT(highest, 0.1F) << "he has lifted his hand over the shoulder";
    for (int i = 0; i < 40; ++i) {
      r.frame();
      judge.look(r.last, std::string("after ") + name);
    }
  }
  expect_within_bounds(judge);
}

TEST_F(ClipFolder, NamesTheFileThatCannotBeUsed) {
  const std::vector<std::pair<std::string, std::string>> bad{
      {"empty.bvh", ""},
      {"words.bvh", "this is no motion"},
      {"words.gltf", "{\"asset\": {\"version\": \"2.0\"}}"},
      {"cut.glb", std::string("glTF\2\0\0\0\0\1\0\0", 12)},
      {"bones.bvh",
       "HIERARCHY\nROOT Thing\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 "
       "0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n0 0 0\n0 0 0\n"},
      {"nothing.json", "{\"name\": \"nothing\", \"seconds\": 1, \"tracks\": {}}"}};
  for (const auto& [name, bytes] : bad) {
    const auto clip = read_clip_file(put(name, bytes));
    ASSERT_FALSE(clip) << name;
    EXPECT_NE(clip.error().message.find(name), std::string::npos) << clip.error().message;
  }
  EXPECT_FALSE(read_clip_file(folder_ / "absent.bvh"));
  EXPECT_FALSE(clips_with_folder(folder_ / "absent"));
}

TEST_F(ClipFolder, TakesNoNameThatIsTakenOrThatNobodyCanGive) {
  const std::string wink =
      R"({"name": "wink", "seconds": 1, "tracks": {"head": [[0, 0,0,0], [0.5, 5,0,0], [1, 0,0,0]]}})";
  put("slow_nod.json", wink);
  const auto clips = clips_with_folder(folder_);
  ASSERT_TRUE(clips) << clips.error().message;
  EXPECT_EQ(clips->count("slow_nod"), 1U);
  EXPECT_EQ(clips->count("nod"), 1U) << "besides those made here";
  const fs::path taken = put("nod.json", wink);
  EXPECT_FALSE(clips_with_folder(folder_));
  fs::remove(taken);
  put("Not A Name.json", wink);
  EXPECT_FALSE(clips_with_folder(folder_));
}

TEST_F(ClipFolder, ReadsNothingThatDoesNotLieBesideIt) {
  std::string text = bytes_of(data / "greet_gltf.gltf");
  const std::size_t from = text.find("\"uri\": \"") + 8;
  const std::size_t to = text.find('"', from);
  fs::create_directories(folder_ / "clips");
  std::ofstream(folder_ / "secret.bin") << std::string(100'000, 'x');
  text.replace(from, to - from, "../secret.bin");
  std::ofstream(folder_ / "clips" / "spy.gltf") << text;
  EXPECT_FALSE(read_clip_file(folder_ / "clips" / "spy.gltf"));
}

// Files that were cut off, or in which bytes have changed: an error, or a clip that is one.
TEST_F(ClipFolder, SurvivesBrokenFiles) {
  std::mt19937 random(5);
  int read = 0;
  for (const char* name : {"greet_bvh.bvh", "greet_gltf.gltf"}) {
    const std::string whole = bytes_of(data / name);
    const std::string kind = fs::path(name).extension().string();
    for (int round = 0; round < 120; ++round) {
      std::string bytes = whole;
      if (round % 3 == 0) bytes.resize(random() % whole.size());
      for (unsigned k = 0; round % 3 != 0 && k < 1 + random() % 6; ++k) {
        bytes[random() % bytes.size()] = static_cast<char>(round % 3 == 1 ? 32 + random() % 95 : random() % 256);
      }
      const auto clip = read_clip_file(put("broken" + kind, bytes));
      if (!clip) continue;
      ++read;
      BodyControls controls;
      for (float t = 0; t < clip->seconds && t < 3; t += 0.1F) add_clip(*clip, t, 1, ~0U, controls);
      EXPECT_TRUE(std::isfinite(controls.head.pitch + controls.spine.pitch + controls.pelvis.pitch)) << round;
    }
  }
  EXPECT_GT(read, 20) << "some of them say what they mean";
}

}  // namespace
}  // namespace counterpart
