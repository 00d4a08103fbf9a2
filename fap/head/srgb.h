/// @file
/// sRGB, the colours of files and screens, and linear light, the colours of meshes.
#pragma once

#include <cmath>
#include <concepts>

#include "fap/head/vector.h"

namespace animeme::head {

/// One channel of a colour, 0..1 to 0..1 (IEC 61966-2-1).
template <std::floating_point T>
T linear_of_srgb(T value) {
  return value <= T(0.04045) ? value / T(12.92) : std::pow((value + T(0.055)) / T(1.055), T(2.4));
}
/// One channel, 0..1, from linear light.
template <std::floating_point T>
T srgb_of_linear(T value) {
  return value <= T(0.0031308) ? value * T(12.92)
                               : T(1.055) * std::pow(value, 1 / T(2.4)) - T(0.055);
}

/// All three channels.
inline Vec3 linear_of_srgb(Vec3 c) {
  return {linear_of_srgb(c.x), linear_of_srgb(c.y), linear_of_srgb(c.z)};
}
/// A colour, 0..1, from linear light.
inline Vec3 srgb_of_linear(Vec3 c) {
  return {srgb_of_linear(c.x), srgb_of_linear(c.y), srgb_of_linear(c.z)};
}

}  // namespace animeme::head
