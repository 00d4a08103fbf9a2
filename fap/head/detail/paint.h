// Colours and light of the parts.
#pragma once

#include "fap/head/detail/grid.h"

namespace animeme::head::detail {

/// sRGB 0xRRGGBB as linear RGB.
Vec3 linear_colour(std::uint32_t srgb);

/// Colours of the skin by place, lips and rims by row.
void paint_skin(const Shape& shape, Skin& skin);

}  // namespace animeme::head::detail
