#include "protocol/transport/video_choice.hpp"

#include <gtest/gtest.h>

namespace counterpart {
namespace {

constexpr std::int64_t kFrameNs = 40'000'000;
constexpr std::size_t kPicture = 720 * 576 * 3;  // at 25 a second 31 MB/s
constexpr double kMegabyte = 1e6;

// What so many pictures later the newest goes out as.
PixelCodec after(VideoChoice& choice, std::int64_t& now_ns, int pictures, const VideoLinks& links) {
  PixelCodec codec = PixelCodec::raw_bgr8;
  for (int i = 0; i < pictures; ++i) codec = choice.choose(kPicture, links, now_ns += kFrameNs);
  return codec;
}

TEST(VideoChoice, IsRawOnThisHostWhateverIsDropped) {
  VideoChoice choice;
  std::int64_t now_ns = 0;
  EXPECT_EQ(after(choice, now_ns, 10, {true, 0, 0}), PixelCodec::raw_bgr8);
  EXPECT_EQ(after(choice, now_ns, 10, {true, 0, 50}), PixelCodec::raw_bgr8);
}

TEST(VideoChoice, BetweenHostsIsJpegUntilTheLinkHasShownThatItCarriesRawTwice) {
  VideoChoice choice;
  std::int64_t now_ns = 0;
  EXPECT_EQ(after(choice, now_ns, 50, {false, 0, 0}), PixelCodec::jpeg) << "nothing is known";
  EXPECT_EQ(after(choice, now_ns, 50, {false, 12 * kMegabyte, 0}), PixelCodec::jpeg) << "100 Mbit/s";
  EXPECT_EQ(after(choice, now_ns, 50, {false, 100 * kMegabyte, 0}), PixelCodec::raw_bgr8) << "1 Gbit/s";
}

TEST(VideoChoice, ADroppedPictureEndsRawForAWhileThatGrows) {
  VideoChoice choice;
  std::int64_t now_ns = 0;
  VideoLinks links{false, 100 * kMegabyte, 0};
  ASSERT_EQ(after(choice, now_ns, 5, links), PixelCodec::raw_bgr8);
  links.dropped = 1;
  EXPECT_EQ(after(choice, now_ns, 1, links), PixelCodec::jpeg);
  EXPECT_EQ(after(choice, now_ns, 9 * 25, links), PixelCodec::jpeg) << "nine seconds later";
  EXPECT_EQ(after(choice, now_ns, 2 * 25, links), PixelCodec::raw_bgr8) << "tried again after ten";
  links.dropped = 2;
  EXPECT_EQ(after(choice, now_ns, 19 * 25, links), PixelCodec::jpeg) << "it is trusted less";
  EXPECT_EQ(after(choice, now_ns, 2 * 25, links), PixelCodec::raw_bgr8);
}

TEST(VideoChoice, FastSmallPicturesAreJudgedByWhatTheyNeed) {
  VideoChoice choice;
  std::int64_t now_ns = 0;
  const VideoLinks link{false, 50 * kMegabyte, 0};
  PixelCodec codec = PixelCodec::jpeg;
  for (int i = 0; i < 100; ++i) codec = choice.choose(320 * 240 * 3, link, now_ns += kFrameNs);
  EXPECT_EQ(codec, PixelCodec::raw_bgr8) << "5.8 MB/s";
}

}  // namespace
}  // namespace counterpart
