// Any bytes: the decoder ends, decode() agrees with it, and access units can be made.
#include <cstdint>
#include <cstdlib>

#include "codec/decode/access_unit.h"
#include "tests/fuzz/event_trace.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

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
  return 0;
}
