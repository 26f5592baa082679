// A compressed picture becomes a texture; the only place where this room decodes pictures.
#pragma once

#include <filesystem>
#include <span>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

// PNG, JPEG or what else OpenCV knows, of eight bits a channel and at most 8192 pixels a side.
Result<Texture> decode_texture(std::span<const unsigned char> bytes);

// The same from a file; says which one if it cannot be read.
Result<Texture> read_texture(const std::filesystem::path& file);

}  // namespace counterpart
