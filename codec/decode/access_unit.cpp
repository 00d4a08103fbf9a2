#include "codec/decode/access_unit.h"

#include <array>

namespace animeme::fba {

std::vector<std::uint8_t> join_access_units(const AccessUnits& units, bool with_headers) {
  std::vector<std::uint8_t> out;
  if (with_headers) out = units.config;
  for (const AccessUnit& unit : units.units) {
    out.insert(out.end(), unit.bytes.begin(), unit.bytes.end());
  }
  const auto end = end_code();
  out.insert(out.end(), end.begin(), end.end());
  return out;
}

std::span<const std::uint8_t> end_code() {
  static constexpr std::array<std::uint8_t, 4> kEnd = {0x00, 0x00, 0x01, 0xB1};
  return kEnd;
}

}  // namespace animeme::fba
