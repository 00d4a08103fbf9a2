// Where a head of others is and how large.
#pragma once

#include "fap/head/own_head.h"

namespace animeme::head::detail {

/// Turns the head so that its axes are those of Head, if its points tell that they are not: to the
/// nearest of the 24 ways to name axes. True if it was turned.
bool turn_upright(Source& source);

/// p becomes (p - origin) * scale, everywhere in the source.
void move_and_scale(Source& source, Vec3 origin, float scale);

/// Centimetres of a unit for eyes that are `distance` units apart, and its name ("metres"); an
/// empty name: no unit fits, the head is brought to usual size.
struct LengthUnit {
  double centimetres = 1;
  std::string_view name;
};
LengthUnit unit_of(double distance);

/// Place of a point; nothing if the source does not have it.
std::optional<Vec3> place_of(const Source& source, std::string_view id);

/// Between left and right point, if the source has both.
std::optional<Vec3> between(const Source& source, std::string_view left, std::string_view right);

}  // namespace animeme::head::detail
