// Colours and light of the parts.
#pragma once

#include "fap/head/detail/grid.h"

namespace animeme::head::detail {

/// Skin that lines the mouth; linear RGB.
inline constexpr Vec3 kMouthInside{0.13f, 0.022f, 0.02f};

/// sRGB 0xRRGGBB as linear RGB.
Vec3 linear_colour(std::uint32_t srgb);

/// How far a beard covers a place of the skin, 0..1.
float beard_share(const Shape& shape, Vec3d p);
/// How deep a line of age is at a place of the face, 0..1.
double age_line(const HeadParameters& parameters, Vec3d p);

/// Colours of the skin by place, lips and rims by row.
void paint_skin(const Shape& shape, Skin& skin);

}  // namespace animeme::head::detail
