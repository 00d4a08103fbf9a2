#include "tools/app/commands/edit_planes.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace animeme::tools {
namespace {

constexpr std::size_t kPlanesAtOnce = 256;

using TakePlane = std::function<Result<bool>(const fba::Plane&)>;

// The planes of a source, as long as `take` returns true; the last one is told.
Result<void> each_plane(const EditSource& source,
                        const std::function<Result<bool>(const fba::Plane&, bool last)>& take) {
  if (source.stream == nullptr) {
    const std::vector<fba::Plane>& planes = source.motion.decoded.planes;
    for (const fba::Plane& plane : planes) {
      const Result<bool> more = take(plane, &plane == &planes.back());
      if (!more || !*more) return more ? Result<void>() : more.error();
    }
    return {};
  }
  PlaneReader reader(source.stream->file);
  std::optional<fba::Plane> before;
  for (;;) {
    const auto next = reader.next();
    if (!next) return next.error();
    if (before) {
      const Result<bool> more = take(*before, *next == nullptr);
      if (!more || !*more) return more ? Result<void>() : more.error();
    }
    if (*next == nullptr) return {};
    before = **next;
  }
}

// The same on the time line of the source: the first pose is held from its beginning, the last one
// up to frame `end`.
Result<void> for_planes(const EditSource& source, std::int64_t end, const TakePlane& take) {
  bool first = true;
  return each_plane(source, [&](const fba::Plane& given, bool last) -> Result<bool> {
    if (std::exchange(first, false) && source.lead > 0) {
      fba::Plane held = given;
      held.number = 0;
      held.temporal.skip.reset();
      if (source.lead > 1) held.temporal.skip = std::uint32_t(source.lead - 1);
      const Result<bool> more = take(held);
      if (!more || !*more) return more;
    }
    fba::Plane plane = given;
    plane.number += source.lead;
    const std::int64_t missing = std::max(source.frames, end) - plane.number - 1;
    if (last && missing > std::int64_t(plane.temporal.skip.value_or(0))) {
      plane.temporal.skip = std::uint32_t(missing);
    }
    return take(plane);
  });
}

bool has_start_codes(const EditCut& cut) {
  if (cut.source->stream) return cut.source->stream->start_codes;
  const std::vector<fba::Plane>& planes = cut.source->motion.decoded.planes;
  return std::ranges::all_of(planes, [](const fba::Plane& plane) { return plane.start_code; });
}

}  // namespace

bool can_copy(const std::vector<EditCut>& cuts, fap::Rate rate) {
  return std::ranges::all_of(cuts, [&](const EditCut& cut) {
    const EditSource& source = *cut.source;
    if (source.stream) return source.stream->one_rate && source.rate == rate;
    return source.coded() &&
           std::ranges::all_of(source.motion.decoded.planes,
                               [&](const fba::Plane& plane) { return plane.rate == rate; });
  });
}

Result<fba::SpliceReport> copy_planes(const std::vector<EditCut>& cuts, std::int64_t hold,
                                      bool start_codes, const TakeStream& take) {
  start_codes = start_codes || std::ranges::all_of(cuts, has_start_codes);
  fba::Splicer splicer(
      {start_codes ? fba::PlaneStartCodes::all : fba::PlaneStartCodes::none, false});
  std::size_t waiting = 0;  // planes whose bytes have not been taken
  for (const EditCut& cut : cuts) {
    splicer.begin_source();
    const std::int64_t held = &cut == &cuts.front() ? hold : 0;
    auto copied = for_planes(*cut.source, cut.end, [&](const fba::Plane& plane) -> Result<bool> {
      const Result<bool> more = splicer.copy_frames(plane, cut.first, cut.end, held);
      if (!more || ++waiting < kPlanesAtOnce) return more;
      waiting = 0;
      if (auto done = take(splicer.take()); !done) return done.error();
      return more;
    });
    if (!copied) return copied.error().in_file(cut.source->path);
  }
  if (auto done = take(splicer.finish()); !done) return done.error();
  return splicer.report();
}

std::vector<std::int64_t> intra_frames(const EditSource& source) {
  std::vector<std::int64_t> frames;
  if (source.lead > 0) frames.push_back(0);
  if (source.stream) {
    for (const std::int64_t number : source.stream->intra) frames.push_back(number + source.lead);
  }
  for (const fba::Plane& plane : source.motion.decoded.planes) {
    if (plane.intra) frames.push_back(plane.number + source.lead);
  }
  return frames;
}

}  // namespace animeme::tools
