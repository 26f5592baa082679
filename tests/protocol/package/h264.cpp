// A program of somebody else that compresses a picture and reads it again.
#include <cstdio>

#include "protocol/h264/h264.hpp"

int main() {
  using namespace counterpart;
  VideoFrame picture;
  picture.stamp = {1, 0};
  picture.width = picture.height = 64;
  picture.stride = 192;
  picture.bytes.assign(192 * 64, 100);
  const auto encoder = make_h264_encoder();
  if (encoder == nullptr) {
    std::puts("this FFmpeg has no libx264");
    return 0;
  }
  const auto coded = encoder->encode(picture, {true, 100'000});
  if (!coded) return 1;
  const auto seen = make_h264_decoder()->decode(*coded);
  if (!seen || !*seen || (*seen)->bytes.size() != picture.bytes.size()) return 1;
  std::puts("the picture came back");
  return 0;
}
