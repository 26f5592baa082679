#include "vhd_renderer/body/decode_texture.hpp"

#include <fstream>
#include <iterator>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace counterpart {

Result<Texture> decode_texture(std::span<const unsigned char> bytes) {
  const cv::Mat packed(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<unsigned char*>(bytes.data()));
  const cv::Mat picture = bytes.empty() ? cv::Mat() : cv::imdecode(packed, cv::IMREAD_UNCHANGED);
  if (picture.empty() || picture.depth() != CV_8U || picture.cols > 8192 || picture.rows > 8192) {
    return failure(ErrorCode::bad_format, "a texture cannot be decoded");
  }
  cv::Mat rgba;
  const int code = picture.channels() == 4   ? cv::COLOR_BGRA2RGBA
                   : picture.channels() == 3 ? cv::COLOR_BGR2RGBA
                                             : cv::COLOR_GRAY2RGBA;
  cv::cvtColor(picture, rgba, code);
  Texture texture{rgba.cols, rgba.rows, {}};
  texture.rgba.assign(rgba.datastart, rgba.dataend);
  return texture;
}

Result<Texture> read_texture(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (bytes.empty()) return failure(ErrorCode::not_found, "the texture " + file.string() + " cannot be read");
  auto texture = decode_texture({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
  if (!texture) return failure(texture.error().code, file.string() + ": " + texture.error().message);
  return texture;
}

}  // namespace counterpart
