/// @file
/// PNG files and contact sheets.
#pragma once

#include "fap/result.h"
#include "tools/view/render/image.h"

namespace animeme::render {

/// A PNG file of 8 bits: RGB, or RGBA where a pixel is not opaque. Errors: invalid_argument (no
/// pixels, or not width
/// * height * 4 bytes), out_of_range (memory).
Result<std::vector<std::uint8_t>> png_of(const Image& image);

/// The pictures, all of one size, in rows of `columns`, with `gap` pixels between them. Missing
/// ones in the last row are dark. Errors: invalid_argument (no pictures, columns < 1, gap < 0,
/// different sizes).
Result<Image> contact_sheet(const std::vector<Image>& pictures, int columns, int gap = 2);

}  // namespace animeme::render
