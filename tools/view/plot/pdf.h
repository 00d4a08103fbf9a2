/// @file
/// Drawings of this folder as PDF.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::plot {

/// One page with the lines, rectangles and texts of an SVG that curves_svg() has made, in its size
/// (without a unit 96 pixels are an inch). Texts stay texts, in Helvetica, which every reader has
/// and the file does not contain; letters beyond Latin-1 become question marks. The same drawing
/// gives the same bytes. Error: syntax (another SVG).
Result<std::vector<std::uint8_t>> drawing_pdf(std::string_view svg);

}  // namespace animeme::plot
