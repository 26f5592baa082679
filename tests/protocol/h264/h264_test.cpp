#include "protocol/h264/h264.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "protocol/transport/jpeg.hpp"

namespace counterpart {
namespace {

constexpr VideoEncoder::Wish kGood{false, 160'000};  // 4 Mbit/s at 25 a second

// A shaded wall with a bright box that moves with the number of the frame, and a camera's noise.
VideoFrame picture_of(FrameId frame, std::uint16_t width = 320, std::uint16_t height = 240) {
  VideoFrame out;
  out.stamp = {frame, static_cast<std::int64_t>(frame) * 40'000'000};
  out.width = width;
  out.height = height;
  out.stride = 3U * width + 4;  // rows are not packed
  out.bytes.resize(std::size_t{out.stride} * height);
  std::mt19937 random(static_cast<unsigned>(frame));
  const unsigned left = 3 * static_cast<unsigned>(frame) % (width - 40);
  for (unsigned y = 0; y < height; ++y) {
    for (unsigned x = 0; x < width; ++x) {
      const bool box = x >= left && x < left + 40 && y >= 60 && y < 100;
      std::uint8_t* pixel = &out.bytes[y * out.stride + 3 * x];
      pixel[0] = static_cast<std::uint8_t>((box ? 30 : 60 + x / 4) + random() % 4);
      pixel[1] = static_cast<std::uint8_t>((box ? 200 : 80 + y / 4) + random() % 4);
      pixel[2] = static_cast<std::uint8_t>((box ? 240 : 110) + random() % 4);
    }
  }
  return out;
}

// Root of the mean squared difference, of 255 levels.
double difference(const VideoFrame& a, const VideoFrame& b) {
  double sum = 0;
  for (std::size_t y = 0; y < a.height; ++y) {
    for (std::size_t x = 0; x < 3U * a.width; ++x) {
      const double d = a.bytes[y * a.stride + x] - b.bytes[y * b.stride + x];
      sum += d * d;
    }
  }
  return std::sqrt(sum / (3.0 * a.width * a.height));
}

class H264 : public testing::Test {
 protected:
  void SetUp() override {
    if (encoder_ == nullptr) GTEST_SKIP() << "this FFmpeg has no libx264";
  }

  VideoFrame encode(const VideoFrame& raw, const VideoEncoder::Wish& wish = kGood) {
    auto coded = encoder_->encode(raw, wish);
    EXPECT_TRUE(coded) << coded.error().message;
    return coded ? *coded : VideoFrame{};
  }

  const std::unique_ptr<VideoEncoder> encoder_ = make_h264_encoder();
  const std::unique_ptr<VideoDecoder> decoder_ = make_h264_decoder();
};

// Noise of 4 levels has a spread of 1.1, which compression takes away; colours at the edges of the box are halved.
TEST_F(H264, APictureComesOutAtOnceAndLooksAsItWentIn) {
  for (FrameId frame = 1; frame <= 60; ++frame) {
    const VideoFrame raw = picture_of(frame);
    const VideoFrame coded = encode(raw);
    EXPECT_EQ(coded.stamp, raw.stamp);
    EXPECT_EQ(coded.codec, PixelCodec::h264);
    const auto seen = decoder_->decode(coded);
    ASSERT_TRUE(seen && *seen) << frame;
    EXPECT_EQ((*seen)->stamp, raw.stamp);
    EXPECT_EQ((*seen)->codec, PixelCodec::raw_bgr8);
    EXPECT_LT(difference(raw, **seen), 4) << frame;
  }
}

TEST_F(H264, IsMuchSmallerThanJpeg) {
  std::size_t coded = 0, jpeg = 0;
  for (FrameId frame = 1; frame <= 50; ++frame) {
    coded += encode(picture_of(frame)).bytes.size();
    jpeg += convert(picture_of(frame), PixelCodec::jpeg)->bytes.size();
  }
  EXPECT_LT(4 * coded, jpeg);
}

TEST_F(H264, SizesThatAreNotEvenComeBackAsTheyWere) {
  const VideoFrame raw = picture_of(1, 101, 77);
  const auto seen = decoder_->decode(encode(raw));
  ASSERT_TRUE(seen && *seen);
  EXPECT_EQ((*seen)->width, 101);
  EXPECT_EQ((*seen)->height, 77);
  EXPECT_LT(difference(raw, **seen), 6);
}

TEST_F(H264, WhatBuildsOnAPictureThatDidNotComeIsNotShownUntilOneBeginsAfresh) {
  ASSERT_TRUE(*decoder_->decode(encode(picture_of(1))));
  static_cast<void>(encode(picture_of(2)));
  EXPECT_FALSE(*decoder_->decode(encode(picture_of(3)))) << "it builds on picture 2";
  EXPECT_FALSE(*decoder_->decode(encode(picture_of(4))));
  const VideoFrame raw = picture_of(5);
  const VideoFrame fresh = encode(raw, {true, kGood.bits_a_picture});
  EXPECT_EQ(fresh.stride, 0U);
  const auto seen = decoder_->decode(fresh);
  ASSERT_TRUE(seen && *seen);
  EXPECT_LT(difference(raw, **seen), 4);
  EXPECT_TRUE(*decoder_->decode(encode(picture_of(6))));
}

TEST_F(H264, FramesLeftOutBeforeCompressingBreakNothing) {
  ASSERT_TRUE(*decoder_->decode(encode(picture_of(10))));
  const VideoFrame coded = encode(picture_of(17));
  EXPECT_EQ(coded.stride, 7U);
  EXPECT_TRUE(*decoder_->decode(coded));
}

TEST_F(H264, SomebodyWhoComesLateSeesAPictureWithinTwoSeconds) {
  FrameId seen_at = 0;
  for (FrameId frame = 1; frame <= 100 && seen_at == 0; ++frame) {
    const VideoFrame coded = encode(picture_of(frame));
    if (frame > 10 && *decoder_->decode(coded)) seen_at = frame;
  }
  EXPECT_LE(seen_at, 61U);
  EXPECT_GT(seen_at, 11U) << "not every picture begins afresh";
}

// Over a second. The first picture of 320x240 in a quarter of 250 kbit/s is blurred, not late.
TEST_F(H264, TheRateFollowsTheWish) {
  FrameId frame = 0;
  const auto bytes_of_a_second = [&](std::int64_t bits_a_picture) {
    std::size_t bytes = 0;
    for (int i = 0; i < 25; ++i) static_cast<void>(encode(picture_of(++frame), {false, bits_a_picture}));
    for (int i = 0; i < 25; ++i) bytes += encode(picture_of(++frame), {false, bits_a_picture}).bytes.size();
    return static_cast<double>(bytes);
  };
  for (const std::int64_t bits : {20'000, 4'000, 20'000}) {
    EXPECT_LT(bytes_of_a_second(bits), 1.3 * 25 * static_cast<double>(bits) / 8) << bits;
  }
}

TEST_F(H264, AnotherSizeBeginsAfresh) {
  ASSERT_TRUE(*decoder_->decode(encode(picture_of(1))));
  const VideoFrame coded = encode(picture_of(2, 160, 120));
  EXPECT_EQ(coded.stride, 0U);
  const auto seen = decoder_->decode(coded);
  ASSERT_TRUE(seen && *seen);
  EXPECT_EQ((*seen)->width, 160);
}

TEST_F(H264, DamagedPicturesAreRefusedAndTheNextFreshOneIsShown) {
  std::mt19937 random(5);
  const VideoFrame good = encode(picture_of(1));
  for (int round = 0; round < 200; ++round) {
    VideoFrame bad = good;
    for (int i = 0; i < 20; ++i) bad.bytes[random() % bad.bytes.size()] = static_cast<std::uint8_t>(random());
    if (round % 4 == 0) bad.bytes.resize(random() % 200 + 1);
    static_cast<void>(decoder_->decode(bad));
  }
  VideoFrame larger = good;
  larger.width = 400;
  EXPECT_FALSE(decoder_->decode(larger)) << "not of the size that was announced";
  VideoFrame nonsense = good;
  nonsense.bytes.assign(1000, 7);
  EXPECT_FALSE(decoder_->decode(nonsense));
  const auto seen = decoder_->decode(good);
  ASSERT_TRUE(seen && *seen);
  EXPECT_LT(difference(picture_of(1), **seen), 4);
}

TEST_F(H264, TheSamePicturesGiveTheSameBytes) {
  const auto other = make_h264_encoder();
  for (FrameId frame = 1; frame <= 20; ++frame) {
    EXPECT_EQ(encode(picture_of(frame)), *other->encode(picture_of(frame), kGood)) << frame;
  }
}

TEST_F(H264, OnlyRawPicturesCanBeCompressed) {
  const auto jpeg = convert(picture_of(1), PixelCodec::jpeg);
  EXPECT_FALSE(encoder_->encode(*jpeg, kGood));
  EXPECT_FALSE(convert(picture_of(1), PixelCodec::h264)) << "it takes the pictures before it";
  EXPECT_FALSE(convert(encode(picture_of(1)), PixelCodec::raw_bgr8));
}

}  // namespace
}  // namespace counterpart
