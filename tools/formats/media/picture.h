/// @file
/// Rendering SVG drawings.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

/// Rows from the top, R G B A, A always 255.
struct Pixels {
  int width = 0;                   ///< pixels
  int height = 0;                  ///< pixels
  std::vector<std::uint8_t> rgba;  ///< width x height x 4
};

/// An SVG drawing as pixels; see svg_to_png(). Errors: as there.
Result<Pixels> svg_to_rgba(std::string_view svg);

/// A PNG file (RGB, 8 bits) of an SVG drawing in its own size. Transparent pixels are undefined:
/// give the drawing a background. Text depends on the fonts of the machine.
/// Errors: unsupported (this FFmpeg was built without librsvg or PNG), syntax (no SVG),
/// out_of_range (memory; more than 32767 pixels in width or height).
Result<std::vector<std::uint8_t>> svg_to_png(std::string_view svg);

}  // namespace animeme::media
