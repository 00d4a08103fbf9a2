// Any stream that decodes can be cut anywhere and joined again: what comes out decodes, has the
// planes that were copied, and their values.
#include <cstdint>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/encode/splice.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;

// The plane that was coded has all values of the one that was copied.
bool has_values_of(const fba::Plane& coded, const fba::Plane& copied) {
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!copied.face.mask[fap]) continue;
    if (!coded.face.mask[fap] || coded.face.value[fap] != copied.face.value[fap]) return false;
  }
  for (std::size_t bap = 1; copied.body && bap <= std::size_t(fba::kBapCount); ++bap) {
    if (!copied.body->mask[bap]) continue;
    if (!coded.body || coded.body->value[bap] != copied.body->value[bap]) return false;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  if (const auto joined = fba::join_streams(bytes))
    require(fba::decode(joined->stream).has_value());
  const auto source = fba::decode(bytes);
  if (!source) return 0;
  // The cuts follow from the bytes.
  std::uint32_t state = 2166136261U;
  for (const std::uint8_t byte : bytes) state = (state ^ byte) * 16777619U;
  const auto random = [&](std::int64_t below) {
    state = state * 1664525U + 1013904223U;
    return std::int64_t(state >> 8) % below;
  };
  const std::int64_t length = source->planes.back().number + 1;
  fba::Splicer splicer({fba::PlaneStartCodes(random(3)), false});
  std::vector<const fba::Plane*> copied;
  for (int piece = 0; piece < 3; ++piece) {
    const std::int64_t first = random(length), end = first + 1 + random(length);
    splicer.begin_source();
    for (const fba::Plane& plane : source->planes) {
      const std::size_t before = splicer.report().planes;
      const auto more = splicer.copy_frames(plane, first, end);
      require(more.has_value());
      if (splicer.report().planes > before) copied.push_back(&plane);
      if (!*more) break;
    }
  }
  const fba::SpliceReport report = splicer.report();
  require(report.planes == copied.size() && report.recoded <= report.planes);
  const auto result = fba::decode(splicer.finish());
  require(result.has_value() && result->planes.size() == copied.size());
  for (std::size_t i = 0; i < copied.size() && report.changed == 0; ++i) {
    require(has_values_of(result->planes[i], *copied[i]));
  }
  return 0;
}
