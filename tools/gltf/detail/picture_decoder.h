// PNG and JPEG, by stb_image.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace animeme::gltf {

struct DecodedPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< rows from the top
};

/// Nothing if the bytes are no PNG or JPEG, are damaged, or have more than 64 million texels.
std::optional<DecodedPicture> decode_picture(std::span<const std::uint8_t> bytes);

}  // namespace animeme::gltf
