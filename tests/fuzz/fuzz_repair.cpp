// Repairs of damaged streams: what is written decodes without an error. The units of what can be
// split are repaired, too, with a gap where the first byte says.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/decode/repair.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const auto repaired = fba::repair_stream(bytes);
  if (!repaired) {
    require(!repaired.error().message.empty());
  } else {
    if (repaired->damage.empty()) require(std::ranges::equal(repaired->stream, bytes));
    for (const fba::Damage& one : repaired->damage) require(!one.describe().empty());
    if (!repaired->damage.empty()) require(fba::decode(repaired->stream).has_value());
  }
  auto units = fba::split_access_units(bytes);
  if (!units || units->units.empty()) return 0;
  const std::size_t gap = data[0] % units->units.size();
  const auto damage = fba::repair_units(*units, std::vector<std::size_t>{gap});
  if (damage) require(fba::decode(fba::join_access_units(*units)).has_value());
  return 0;
}
