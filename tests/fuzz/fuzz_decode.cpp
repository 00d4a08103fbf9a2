// Any bytes: the decoder ends, and what it says does not depend on how the bytes were split.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "codec/access_unit.h"
#include "codec/decoder.h"

namespace {

using animeme::Code;
using animeme::fba::Decoder;
using animeme::fba::Event;

struct Trace {
  std::vector<animeme::fap::Frame> frames;
  std::vector<std::int64_t> errors;  // bit positions
  bool operator==(const Trace&) const = default;
};

Trace run(std::span<const std::uint8_t> bytes, std::size_t step) {
  Decoder decoder;
  Trace trace;
  std::size_t at = 0;
  for (;;) {
    const auto event = decoder.next();
    if (event) {
      if (event->kind == Event::Kind::plane) trace.frames.push_back(event->plane.face);
    } else if (event.error().code == Code::end_of_stream) {
      return trace;
    } else if (event.error().code != Code::need_data) {
      trace.errors.push_back(event.error().where.bit);
    } else if (at == bytes.size()) {
      decoder.finish();
    } else {
      const std::size_t count = std::min(step, bytes.size() - at);
      decoder.push(bytes.subspan(at, count));
      at += count;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  const Trace whole = run(bytes, size + 1);
  const Trace pieces = run(bytes, 1 + size % 13);
  if (whole != pieces) std::abort();
  (void)animeme::fba::split_access_units(bytes);
  return 0;
}
