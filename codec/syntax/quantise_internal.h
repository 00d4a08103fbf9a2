// The quantiser. Not installed API. Source: codec/bitstream.md, section 5.
#pragma once

#include <cstdint>

#include "codec/syntax/plane.h"

namespace animeme::fba::internal {

/// Nearest level, halves away from zero, but exactly half a step counts as 0.
inline std::int64_t quantise(std::int64_t value, std::int64_t step) {
  const std::int64_t magnitude = value < 0 ? -value : value;
  if (magnitude <= step / 2) return 0;
  const std::int64_t rounded = magnitude + step / 2;
  // Most values are small, and a short division takes half the time.
  const std::int64_t level = ((rounded | step) >> 32) == 0
                                 ? std::int64_t(std::uint32_t(rounded) / std::uint32_t(step))
                                 : rounded / step;
  return value < 0 ? -level : level;
}

/// Divisor of the ranges and factor of the steps at fap_quant or the body quantiser index.
inline int scale_at(bool body, int quant) { return body ? bap_scale(quant) : fap_scale(quant); }
/// Quantiser step of a parameter whose step at quantiser 1 is `step`.
inline std::int32_t step_at(bool body, std::int32_t step, int quant) {
  return quant == 0 ? 1 : step * scale_at(body, quant);
}

/// The multiple of the quantiser that is coded for a blend or an intensity of 0..63: the nearest
/// one that is not above 63, which is all that they may be.
inline void keep_legal(std::int32_t& value, int fap_quant) {
  const std::int32_t step = fap_scale(fap_quant);
  value = std::int32_t(quantise(value, step)) * step;
  if (value > 63) value -= step;
}
inline void keep_legal(fap::Viseme& viseme, fap::Expression& expression, int fap_quant) {
  keep_legal(viseme.blend, fap_quant);
  keep_legal(expression.intensity1, fap_quant);
  keep_legal(expression.intensity2, fap_quant);
}

}  // namespace animeme::fba::internal
