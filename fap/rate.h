/// @file
/// Frame rates as exact fractions. 29.97 frames per second is 30000/1001, never a float.
#pragma once

#include <cstdint>
#include <numeric>

namespace animeme::fap {

/// Frames per second = num / den, always in lowest terms when made by make_rate().
/// A rate is valid when both parts are positive.
struct Rate {
  std::uint32_t num = 25;  ///< frames in `den` seconds
  std::uint32_t den = 1;   ///< seconds

  bool valid() const { return num > 0 && den > 0; }  ///< both parts are positive
  double frames_per_second() const { return double(num) / double(den); }  ///< num / den
  /// Seconds from frame 0 to `frame`.
  double seconds(double frame) const { return frame * double(den) / double(num); }

  friend bool operator==(const Rate&, const Rate&) = default;
};

/// num/den in lowest terms; den 0 gives an invalid rate.
inline Rate make_rate(std::uint32_t num, std::uint32_t den = 1) {
  const std::uint32_t divisor = std::gcd(num, den);
  return divisor == 0 ? Rate{0, 0} : Rate{num / divisor, den / divisor};
}

}  // namespace animeme::fap
