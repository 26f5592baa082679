#include "protocol/session/lane.hpp"

#include <gtest/gtest.h>

namespace counterpart {
namespace {

Outgoing picture(FrameId frame, Chain chain) {
  Outgoing out;
  out.type = MessageType::video;
  out.frame_id = frame;
  out.chain = chain;
  out.body = std::make_shared<const Bytes>(100);
  return out;
}

std::vector<FrameId> taken(Lane& lane) {
  std::vector<FrameId> frames;
  while (const Outgoing* next = lane.take()) frames.push_back(next->frame_id);
  return frames;
}

TEST(Lane, OfPicturesThatStandAloneTheNewestTwoWait) {
  Lane lane;
  for (FrameId frame = 1; frame <= 5; ++frame) lane.push(picture(frame, Chain::none));
  EXPECT_EQ(taken(lane), (std::vector<FrameId>{4, 5}));
  EXPECT_EQ(lane.dropped(), 3U);
}

TEST(Lane, PicturesThatBuildOnEachOtherWaitLongerThenAllGo) {
  Lane lane;
  for (FrameId frame = 1; frame <= 8; ++frame) lane.push(picture(frame, frame == 1 ? Chain::begins : Chain::goes_on));
  EXPECT_EQ(lane.dropped(), 0U);
  lane.push(picture(9, Chain::goes_on));
  EXPECT_EQ(lane.dropped(), 9U) << "the ninth is of no use without the eighth";
  lane.push(picture(10, Chain::begins));
  lane.push(picture(11, Chain::goes_on));
  EXPECT_EQ(taken(lane), (std::vector<FrameId>{10, 11}));
}

TEST(Lane, APictureThatBeginsAfreshTakesThePlaceOfAllThatWait) {
  Lane lane;
  for (FrameId frame = 1; frame <= 8; ++frame) lane.push(picture(frame, Chain::goes_on));
  lane.push(picture(9, Chain::begins));
  EXPECT_EQ(taken(lane), std::vector<FrameId>{9});
  EXPECT_EQ(lane.dropped(), 8U);
}

TEST(Lane, InLockstepNoPictureIsDropped) {
  Lane lane(true);
  for (FrameId frame = 1; frame <= 30; ++frame) lane.push(picture(frame, Chain::goes_on));
  EXPECT_EQ(taken(lane).size(), 30U);
}

}  // namespace
}  // namespace counterpart
