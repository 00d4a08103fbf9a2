/// @file
/// SVG drawings as pixels, and picture files.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

/// Rows from the top, R G B A. A is 255 unless a function says otherwise.
struct Pixels {
  int width = 0;                   ///< pixels
  int height = 0;                  ///< pixels
  std::vector<std::uint8_t> rgba;  ///< width x height x 4
};

/// An SVG drawing as pixels; see svg_to_png(). Errors: as there.
Result<Pixels> svg_to_rgba(std::string_view svg);

/// A drawing without a background, to be laid over a picture: the colours are multiplied with A.
/// Errors: as svg_to_png().
Result<Pixels> svg_to_overlay(std::string_view svg);

/// A PNG, JPEG or WebP file, scaled until it covers width x height pixels, and cut at both sides
/// where it is larger then. Transparent parts are as dark as their colours say. Errors: unsupported
/// (another format; this FFmpeg cannot decode it), syntax (damaged), invalid_argument (width or
/// height outside 1..8192), out_of_range (memory; more than 16384 pixels in width or height).
Result<Pixels> covering_picture(std::span<const std::uint8_t> file, int width, int height);

/// A PNG file (RGB, 8 bits) of an SVG drawing in its own size. Transparent pixels are undefined:
/// give the drawing a background. Text depends on the fonts of the machine.
/// Errors: unsupported (this FFmpeg was built without librsvg or PNG), syntax (no SVG),
/// out_of_range (memory; more than 32767 pixels in width or height).
Result<std::vector<std::uint8_t>> svg_to_png(std::string_view svg);

}  // namespace animeme::media
