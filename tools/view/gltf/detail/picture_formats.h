// The three image formats, one file each; picture_decoder.cpp detects the format.
#pragma once

#include "tools/view/gltf/detail/picture_decoder.h"

namespace animeme::gltf {

// No error is handed over from libraries of C by longjmp() but within functions that own nothing.

Result<PictureSize> size_of_png(std::span<const std::uint8_t> bytes);
Result<DecodedPicture> decode_png(std::span<const std::uint8_t> bytes, std::int64_t most_texels);

Result<PictureSize> size_of_jpeg(std::span<const std::uint8_t> bytes);
Result<DecodedPicture> decode_jpeg(std::span<const std::uint8_t> bytes, std::int64_t most_texels);

Result<PictureSize> size_of_webp(std::span<const std::uint8_t> bytes);
Result<DecodedPicture> decode_webp(std::span<const std::uint8_t> bytes, std::int64_t most_texels);

/// What to say of a picture that one of the libraries gives up.
Error damaged_picture(const std::string& why);
/// Of one that cannot be decoded row by row and is large; `remedy` is what to do.
Error too_large_at_once(const std::string& remedy);

/// What the sides of a picture are divided by.
int divisor_of(PictureSize size, std::int64_t most_texels);

/// Takes rows from the top and divides both sides: each texel is the mean of those that it covers.
class Shrinker {
 public:
  Shrinker(PictureSize size, int divisor);

  /// RGBA of the next row; takes no memory, and what comes after the last row is ignored.
  void add(const std::uint8_t* row);
  DecodedPicture take() { return std::move(out_); }

 private:
  void finish_row();

  PictureSize size_;
  int divisor_;
  int in_sums_ = 0;  // rows
  int done_ = 0;     // rows of `out_`
  std::vector<std::uint32_t> sums_;
  DecodedPicture out_;
};

}  // namespace animeme::gltf
