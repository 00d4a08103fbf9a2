// What a decoder wants to know of a face before it begins.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "codec/decode/access_unit.h"

namespace animeme::media {

inline constexpr std::int64_t kLongestTime = std::int64_t(1) << 47;  ///< room for rescaling
inline constexpr std::size_t kLargestUnit = std::size_t(1) << 24;    ///< bytes, also of sound

/// Bytes of the largest access unit.
inline std::size_t largest_unit(const fba::AccessUnits& face) {
  std::size_t largest = 0;
  for (const fba::AccessUnit& unit : face.units) largest = std::max(largest, unit.bytes.size());
  return largest;
}

/// The most bits in any second that begins with a unit.
inline std::int64_t peak_bit_rate(const fba::AccessUnits& face) {
  std::int64_t peak = 0;
  std::int64_t bits = 0;
  std::size_t end = 0;
  for (const fba::AccessUnit& first : face.units) {
    while (end < face.units.size() &&
           face.units[end].time - first.time < std::int64_t(face.timescale)) {
      bits += 8 * std::int64_t(face.units[end++].bytes.size());
    }
    peak = std::max(peak, bits);
    bits -= 8 * std::int64_t(first.bytes.size());
  }
  return peak;
}

/// Buffer and bit rate that a decoder needs.
struct BufferFacts {
  std::size_t largest = 0;     ///< bytes of the largest access unit
  std::int64_t peak_bits = 0;  ///< most bits in any second
};
inline BufferFacts buffer_facts(const fba::AccessUnits& face) {
  return {largest_unit(face), peak_bit_rate(face)};
}

/// Bits a second over the whole clip.
inline std::int64_t mean_bit_rate(const fba::AccessUnits& face) {
  if (face.units.empty()) return 0;
  double bytes = 0;
  for (const fba::AccessUnit& unit : face.units) bytes += double(unit.bytes.size());
  const fba::AccessUnit& last = face.units.back();
  const double ticks = double(last.time + last.duration - face.units.front().time);
  return std::int64_t(bytes * 8 * face.timescale / std::max(ticks, 1.0));
}

}  // namespace animeme::media
