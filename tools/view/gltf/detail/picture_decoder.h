// PNG, JPEG and WebP, by libpng, libjpeg-turbo and libwebp. All that can be known from a header is
// known before anything is decoded or memory taken for it; rows are made smaller as they come, so
// that a large picture never lies in memory whole.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::gltf {

/// The widest and highest picture that is decoded, and the most texels of one (8192 x 8192).
inline constexpr int kLongestSide = 16384;
inline constexpr std::int64_t kMostTexels = 67'108'864;
/// Texels of pictures that cannot be decoded row by row: interlaced, progressive, lossless WebP.
inline constexpr std::int64_t kMostTexelsAtOnce = 16'777'216;

struct PictureSize {
  int width = 0;
  int height = 0;

  std::int64_t texels() const { return std::int64_t(width) * height; }
};

struct DecodedPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< rows from the top
};

/// What the header says; texels are not looked at. Errors (sentences that go behind "is left out:
/// "): unsupported (neither PNG nor JPEG nor WebP; an animation), syntax (damaged), out_of_range
/// (larger than the limits above).
Result<PictureSize> size_of_picture(std::span<const std::uint8_t> bytes);

/// "image/png", "image/jpeg" or "image/webp"; empty for others.
std::string type_of_picture(std::span<const std::uint8_t> bytes);

/// The picture, its sides divided by the smallest power of two with which it has no more than
/// `most_texels`. What it says of colour spaces is ignored, as glTF wants it. Errors: as above.
Result<DecodedPicture> decode_picture(std::span<const std::uint8_t> bytes,
                                      std::int64_t most_texels);

}  // namespace animeme::gltf
