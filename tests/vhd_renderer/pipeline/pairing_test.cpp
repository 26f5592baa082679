#include "vhd_renderer/pipeline/pairing.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

// The frame's number is written into the picture and into the pose, so that a wrong pairing shows.
VideoFrame video(FrameId frame) {
  VideoFrame out;
  out.stamp.frame_id = frame;
  out.bytes = {static_cast<std::uint8_t>(frame & 255)};
  return out;
}

PoseEstimate pose(FrameId frame) {
  PoseEstimate out;
  out.stamp.frame_id = frame;
  out.X_CB.p[0] = static_cast<double>(frame & 255);
  return out;
}

void expect_own_pose(const PairedFrame& pair) {
  EXPECT_EQ(pair.video.stamp.frame_id, pair.pose.stamp.frame_id);
  EXPECT_EQ(static_cast<double>(pair.video.bytes[0]), pair.pose.X_CB.p[0]);
}

TEST(Pairing, NothingComesUntilBothHalvesAreThere) {
  Pairing pairing(PairingPolicy::newest);
  pairing.add(video(7));
  EXPECT_FALSE(pairing.take());
  pairing.add(pose(8));
  EXPECT_FALSE(pairing.take());
  pairing.add(pose(7));
  const auto pair = pairing.take();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->video.stamp.frame_id, 7u);
  EXPECT_FALSE(pairing.take());
}

TEST(Pairing, NewestPairWinsAndTheOlderOnesAreCounted) {
  Pairing pairing(PairingPolicy::newest);
  for (FrameId frame : {1, 2, 3}) {
    pairing.add(video(frame));
    pairing.add(pose(frame));
  }
  EXPECT_EQ(pairing.take()->video.stamp.frame_id, 3u);
  EXPECT_EQ(pairing.dropped(), 2u);
  pairing.add(video(2));  // late: never shown after a newer one
  pairing.add(pose(2));
  EXPECT_FALSE(pairing.take());
}

TEST(Pairing, APictureThatASlowLinkBringsHalfASecondLaterMeetsItsPose) {
  Pairing pairing(PairingPolicy::newest);
  constexpr FrameId kBehind = 12;
  int shown = 0;
  for (FrameId frame = 1; frame <= 100; ++frame) {
    pairing.add(pose(frame));
    if (frame <= kBehind || frame % 2 != 0) continue;  // it carries every second one
    pairing.add(video(frame - kBehind));
    const auto pair = pairing.take();
    ASSERT_TRUE(pair) << "frame " << frame - kBehind;
    expect_own_pose(*pair);
    ++shown;
  }
  EXPECT_EQ(shown, 44);
  EXPECT_EQ(pairing.dropped(), 0u);
}

TEST(Pairing, LockstepGivesEveryPairInOrder) {
  Pairing pairing(PairingPolicy::every);
  for (FrameId frame = 0; frame < 20; ++frame) pairing.add(video(frame));
  for (FrameId frame = 0; frame < 20; ++frame) pairing.add(pose(frame));
  for (FrameId frame = 0; frame < 20; ++frame) EXPECT_EQ(pairing.take()->video.stamp.frame_id, frame);
  EXPECT_EQ(pairing.dropped(), 0u);
}

TEST(Pairing, NeverPairsAnotherFramesPoseWhateverIsLostOrLate) {
  std::mt19937 random(1);
  Pairing pairing(PairingPolicy::newest);
  std::vector<FrameId> late;
  FrameId last = 0;
  int shown = 0;
  for (FrameId frame = 1; frame < 20'000; ++frame) {
    if (random() % 50 != 0) pairing.add(video(frame));
    if (random() % 50 == 0) continue;  // pose lost
    if (random() % 10 == 0) {
      late.push_back(frame);
    } else {
      pairing.add(pose(frame));
    }
    if (late.size() > 2) {
      for (const FrameId id : late) pairing.add(pose(id));
      late.clear();
    }
    if (const auto pair = pairing.take()) {
      expect_own_pose(*pair);
      EXPECT_GT(pair->video.stamp.frame_id, last);
      last = pair->video.stamp.frame_id;
      ++shown;
    }
  }
  EXPECT_GT(shown, 15'000);
}

TEST(Pairing, AnotherSourceStartsAnew) {
  Pairing pairing(PairingPolicy::newest);
  pairing.add(video(100));
  pairing.add(pose(100));
  ASSERT_TRUE(pairing.take());
  pairing.restart();
  pairing.add(video(0));
  pairing.add(pose(0));
  EXPECT_TRUE(pairing.take());
}

}  // namespace
}  // namespace counterpart
