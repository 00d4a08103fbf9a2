// What a mirrored face does, and which values a stream can carry. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fap/tables.h"

namespace animeme::fap::internal {

/// The FAP of a mirrored face that has the value of a FAP, times `sign`.
struct MirrorImage {
  int fap;
  int sign;
};

/// A mirrored face has the value of a FAP on its partner. FAPs that point to one side of the
/// world and not of the face (yaw of both eyes is positive to the left) change their sign.
inline MirrorImage mirror_image(int number) {
  const FapInfo& fap = info(number);
  const int partner = fap.mirror != 0 ? fap.mirror : number;
  const bool sideways = fap.motion == Motion::left || fap.motion == Motion::right;
  return {partner, sideways && info(partner).motion == fap.motion ? -1 : 1};
}

/// Rounded to the nearest unit, and clipped to what FBA can carry at fap_quant 1: +-1860 steps.
/// Sums that are none (infinities of both signs) give 0; what std::lround() makes of them differs
/// from machine to machine.
inline std::int32_t coded_value(double value, int fap) {
  constexpr int kLongestLevel = 1860;  // 31 * 60, the widest range of a stream
  if (std::isnan(value)) return 0;
  const double limit = double(kLongestLevel) * info(fap).quant_step;
  return std::int32_t(std::lround(std::clamp(value, -limit, limit)));
}

}  // namespace animeme::fap::internal
