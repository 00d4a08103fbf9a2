// Truevision TGA, the pictures that Xface reads.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/head/wrl.h"
#include "fap/result.h"

namespace animeme::head::detail {

/// Texels in rows from the bottom to the top, sRGB, 8 bits per channel.
struct TgaPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  /// What Xface would not show as it is meant, the end of a sentence; empty: nothing.
  std::string trouble;

  const std::uint8_t* texel(int x, int y) const {
    return &rgb[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3];
  }
};

/// Reads types 2, 3, 10 and 11 (colour with 24 or 32 bits, grey with 8; plain or run-length), in
/// any order of rows. What alpha there is does not count.
/// Errors: unsupported (other types and depths), out_of_range (no texel, or more than 16 million),
/// truncated. Sentences are about "the picture", for the caller to name.
Result<TgaPicture> read_tga(std::string_view bytes);

/// Type 2 with 24 bits from the bottom, which every reader of TGA knows.
std::string write_tga(const TgaPicture& picture);

/// The colour at a place in linear light: between the four texels around it, repeated beyond the
/// borders.
Vec3 colour_at(const TgaPicture& picture, TexturePlace place);

}  // namespace animeme::head::detail
