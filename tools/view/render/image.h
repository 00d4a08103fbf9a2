/// @file
/// Pictures in memory.
#pragma once

#include <cstdint>
#include <vector>

namespace animeme::render {

/// Rows from the top, pixels from the left, 4 bytes each: R, G, B (sRGB, not multiplied with A), A
/// (255 but in pictures without a background).
struct Image {
  int width = 0;                   ///< pixels
  int height = 0;                  ///< pixels
  std::vector<std::uint8_t> rgba;  ///< width x height x 4

  friend bool operator==(const Image&, const Image&) = default;
};

}  // namespace animeme::render
