#include "protocol/transport/video_choice.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

constexpr std::int64_t kFrameNs = 40'000'000;
constexpr std::size_t kPicture = 720 * 576 * 3;  // at 25 a second 31 MB/s
constexpr double kMegabyte = 1e6;

// What so many pictures later the newest goes out as.
PixelCodec after(VideoChoice& choice, std::int64_t& now_ns, int pictures, const VideoLinks& links) {
  PixelCodec codec = PixelCodec::raw_bgr8;
  for (int i = 0; i < pictures; ++i) codec = choice.choose(kPicture, links, now_ns += kFrameNs).codec;
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

// A line that carries so many bytes a second; a JPEG of quality 92 has 120 kB, and each step less two thirds of it.
TEST(VideoChoice, PicturesBecomeSmallerUntilASlowLinkCarriesAllAndLargerWhenItIsBetter) {
  VideoChoice choice;
  std::int64_t now_ns = 0;
  VideoLinks links{false, 0, 0};
  const auto quality_after = [&](double megabytes_per_second, int seconds) {
    int quality = 0;
    double waiting = 0;  // bytes
    for (int i = 0; i < 25 * seconds; ++i) {
      quality = choice.choose(kPicture, links, now_ns += kFrameNs).quality;
      const double size = quality > 90 ? 120e3 : quality > 80 ? 80e3 : quality > 60 ? 53e3 : quality > 40 ? 36e3 : 24e3;
      waiting = std::max(0.0, waiting + size - megabytes_per_second * kMegabyte / 25);
      if (waiting < 3 * size) continue;
      waiting -= size;
      ++links.dropped;
    }
    return quality;
  };
  EXPECT_EQ(quality_after(5, 10), kJpegQuality) << "40 Mbit/s carry 25 of 120 kB";
  EXPECT_EQ(quality_after(1, 8), 50) << "8 Mbit/s carry 25 of 36 kB";
  EXPECT_GE(quality_after(1, 300), 50) << "what was too much is tried seldom";
  EXPECT_EQ(quality_after(5, 1200), kJpegQuality);
}

TEST(VideoChoice, ASlowLinkGoesOverToH264IfAllViewersTakeIt) {
  VideoChoice choice;
  std::int64_t now_ns = 0;
  VideoLinks links{false, 3 * kMegabyte / 8, 0, 0, true};
  VideoForm form;
  // Each second a picture is dropped as long as more goes out than 3 Mbit/s; JPEG always does. What the link delivers
  // is known then, so 8 and 4 Mbit/s are not even tried.
  const auto seconds_pass = [&](int seconds) {
    for (int i = 0; i < 25 * seconds; ++i) {
      form = choice.choose(kPicture, links, now_ns += kFrameNs);
      if (i % 25 == 0 && (form.codec != PixelCodec::h264 || form.bits_a_picture > 3'000'000 / 25)) ++links.dropped;
    }
  };
  seconds_pass(3);
  EXPECT_EQ(form.codec, PixelCodec::h264);
  EXPECT_EQ(form.bits_a_picture, 2'000'000 / 25);
  links.h264 = false;  // a viewer came who does not take it
  EXPECT_EQ(choice.choose(kPicture, links, now_ns += kFrameNs).codec, PixelCodec::jpeg);
}

TEST(VideoChoice, WhatIsAlwaysLateIsTooMuchThoughNothingIsDropped) {
  VideoChoice choice(PixelCodec::h264);
  std::int64_t now_ns = 0;
  const auto bits_after = [&](int pictures, std::uint32_t waiting) {
    VideoForm form;
    for (int i = 0; i < pictures; ++i)
      form = choice.choose(kPicture, {false, kMegabyte, 0, waiting, true}, now_ns += kFrameNs);
    return form.bits_a_picture * 25;
  };
  EXPECT_EQ(bits_after(25, 0), 8'000'000);
  EXPECT_EQ(bits_after(8, 4), 8'000'000) << "the link hesitated";
  EXPECT_EQ(bits_after(25, 0), 8'000'000);
  EXPECT_EQ(bits_after(12, 4), 4'000'000);
}

TEST(VideoChoice, H264SpreadsItsRateOverThePicturesThatCome) {
  VideoChoice choice(PixelCodec::h264);
  const VideoLinks links{false, 0, 0, 0, true};
  VideoForm form;
  for (int i = 1; i <= 100; ++i) form = choice.choose(kPicture, links, i * 2 * kFrameNs);
  EXPECT_NEAR(static_cast<double>(form.bits_a_picture), 8e6 / 12.5, 1e4) << "12.5 a second";
}

TEST(VideoChoice, KeepsToTheCodecThatWasAskedFor) {
  VideoLinks links{false, 100 * kMegabyte, 0, 0, true};
  for (const auto codec : {PixelCodec::raw_bgr8, PixelCodec::jpeg, PixelCodec::h264}) {
    VideoChoice choice(codec);
    for (int i = 1; i <= 500; ++i) {
      if (i % 50 == 0) ++links.dropped;
      EXPECT_EQ(choice.choose(kPicture, links, i * kFrameNs).codec, codec);
    }
  }
  links.h264 = false;
  EXPECT_EQ(VideoChoice(PixelCodec::h264).choose(kPicture, links, kFrameNs).codec, PixelCodec::jpeg);
}

TEST(VideoChoice, FastSmallPicturesAreJudgedByWhatTheyNeed) {
  VideoChoice choice;
  std::int64_t now_ns = 0;
  const VideoLinks link{false, 50 * kMegabyte, 0};
  PixelCodec codec = PixelCodec::jpeg;
  for (int i = 0; i < 100; ++i) codec = choice.choose(320 * 240 * 3, link, now_ns += kFrameNs).codec;
  EXPECT_EQ(codec, PixelCodec::raw_bgr8) << "5.8 MB/s";
}

}  // namespace
}  // namespace counterpart
