/// @file
/// Image files: PNG, JPEG and WebP, and animated WebP.
///
///     auto animation = Animation::open(640, 640);
///     for (...) animation->push(image.rgba, milliseconds);
///     auto file = animation->finish(end);
///
/// Uses libjpeg-turbo and libwebp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/view/render/image.h"

namespace animeme::studio {

/// Whether the extension is ".png", ".jpg", ".jpeg" or ".webp", in lower case.
bool is_picture(std::string_view extension);

/// Encodes an image in that format; JPEG is without alpha. `quality` 1..100 for JPEG and WebP.
/// Errors: unsupported (another extension), invalid_argument (no pixels, or not width * height * 4
/// bytes; a side above 65535, of WebP 16383), out_of_range (memory).
Result<std::vector<std::uint8_t>> picture_of(const render::Image& image, std::string_view extension,
                                             int quality = 90);

/// An animated WebP in an endless loop. Movable, not copyable.
class Animation {
 public:
  /// Sides 1..16383, quality 1..100. Errors: invalid_argument, out_of_range (memory).
  static Result<Animation> open(int width, int height, int quality = 80);
  Animation(Animation&&) noexcept;  ///< movable
  Animation& operator=(Animation&&) noexcept;
  ~Animation();

  /// Adds the picture shown from `milliseconds`; times ascend. Errors: invalid_argument (size),
  /// out_of_range (memory).
  Result<void> push(std::span<const std::uint8_t> rgba, int milliseconds);
  /// Returns the file; the last picture lasts until `milliseconds`. Errors: as above.
  Result<std::vector<std::uint8_t>> finish(int milliseconds);

 private:
  struct Impl;
  explicit Animation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::studio
