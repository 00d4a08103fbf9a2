#include "codec/syntax/plane.h"

namespace animeme::fba {

std::optional<CodedRate> code_rate(fap::Rate rate) {
  if (!rate.valid()) return std::nullopt;
  for (const bool offset : {false, true}) {
    // sixteenths = 16 * rate, times 1001/1000 if the offset is to bring it back down.
    const std::uint64_t num = std::uint64_t(rate.num) * 16U * (offset ? 1001U : 1U);
    const std::uint64_t den = std::uint64_t(rate.den) * (offset ? 1000U : 1U);
    if (num % den != 0) continue;
    const std::uint64_t sixteenths = num / den;
    if (sixteenths == 0 || sixteenths > 255U * 16U + 15U) continue;
    return CodedRate{std::uint8_t(sixteenths / 16), std::uint8_t(sixteenths % 16), offset};
  }
  return std::nullopt;
}

}  // namespace animeme::fba
