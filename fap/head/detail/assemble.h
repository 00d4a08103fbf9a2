// The last steps of make_head().
#pragma once

#include "fap/head/detail/parts.h"

namespace animeme::head::detail {

/// Where the ears begin and end among the vertices of the skin.
struct EarVertices {
  std::uint32_t left_first, right_first, end;
};

/// Adds both ears to the skin.
EarVertices add_ears(const Shape& shape, Mesh& skin);

/// Soft shadows of the parts on each other, into the occlusion of skin, hair and body.
void shade_parts(const Shape& shape, const Skin& skin, Head& head);

/// All 84 points.
void find_feature_points(const Shape& shape, const Skin& skin, const EarVertices& ears, Head& head);

/// Skin that hair covers is made to slide, lest it comes through: 0 there, 1 where it is seen.
std::vector<float> freedom_below_hair(const Shape& shape, const Mesh& skin);

/// How far the vertices of the skin go along with the four lids.
void weigh_lids(const Shape& shape, Skin& skin, std::size_t vertices);

}  // namespace animeme::head::detail
