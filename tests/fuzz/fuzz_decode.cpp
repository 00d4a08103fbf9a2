// Any bytes: the decoder ends, decode() agrees with it, access units can be made, and what
// repair_stream() makes of them decodes.
#include <algorithm>
#include <cstdint>

#include "codec/decode/access_unit.h"
#include "codec/decode/repair.h"
#include "tests/fuzz/event_trace.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme;
  const std::span bytes(data, size);
  const auto events = test::trace(bytes, [size](std::size_t) { return size; });
  const auto decoded = fba::decode(bytes);
  std::size_t planes = 0;
  const Error* first_error = nullptr;
  for (const auto& [event, error, failed] : events) {
    if (failed) {
      require(!error.message.empty());
      require(error.where.bit >= 0 && error.where.bit <= std::int64_t(size) * 8);
      if (first_error == nullptr) first_error = &error;
    } else if (event.kind == fba::Event::Kind::plane) {
      if (decoded) require(decoded->planes.at(planes).face == event.plane.face);
      ++planes;
    }
  }
  if (decoded) {
    require(first_error->code == Code::end_of_stream && decoded->planes.size() == planes);
  } else if (planes > 0) {
    require(decoded.error().message == first_error->message);
  }
  const auto units = fba::split_access_units(bytes);
  require(units.has_value() == decoded.has_value());
  const auto repaired = fba::repair_stream(bytes);
  if (repaired) {
    require(!repaired->damage.empty() || std::ranges::equal(repaired->stream, bytes));
    require(!repaired->damage.empty() || decoded.has_value());
    if (!repaired->damage.empty()) require(fba::decode(repaired->stream).has_value());
  } else {
    require(!decoded);
  }
  if (units) {
    fba::AccessUnits copy = *units;
    const auto damage = fba::repair_units(copy);
    require(damage.has_value() && damage->empty() == (copy == *units));
  }
  return 0;
}
