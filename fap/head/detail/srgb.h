// sRGB, the colours of files, and linear light, the colours of meshes.
#pragma once

#include "fap/head/vector.h"

namespace animeme::head::detail {

/// 0..1 to 0..1.
inline float linear_of_srgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}
inline float srgb_of_linear(float value) {
  return value <= 0.0031308f ? value * 12.92f : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
}
inline Vec3 linear_of_srgb(Vec3 c) {
  return {linear_of_srgb(c.x), linear_of_srgb(c.y), linear_of_srgb(c.z)};
}
inline Vec3 srgb_of_linear(Vec3 c) {
  return {srgb_of_linear(c.x), srgb_of_linear(c.y), srgb_of_linear(c.z)};
}

}  // namespace animeme::head::detail
