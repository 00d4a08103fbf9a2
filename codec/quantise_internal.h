// The quantiser. Not installed API. Source: fba_bitstream, section 5.
#pragma once

#include <cstdint>

namespace animeme::fba::internal {

/// Nearest level, halves away from zero, but exactly half a step counts as 0.
inline std::int64_t quantise(std::int64_t value, std::int64_t step) {
  const std::int64_t magnitude = value < 0 ? -value : value;
  if (magnitude <= step / 2) return 0;
  const std::int64_t level = (magnitude + step / 2) / step;
  return value < 0 ? -level : level;
}

}  // namespace animeme::fba::internal
