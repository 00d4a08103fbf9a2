#include "tools/app/commands/edit_planes.h"

#include <algorithm>

namespace animeme::tools {
namespace {

// Calls `take` with the planes of a source on its own time line, as long as it returns true: the
// first pose is held from its beginning, the last one up to frame `end`.
template <class Take>
Result<void> for_planes(const EditSource& source, std::int64_t end, const Take& take) {
  const std::vector<fba::Plane>& planes = source.motion.decoded.planes;
  if (source.lead > 0) {
    fba::Plane held = planes.front();
    held.number = 0;
    held.temporal.skip.reset();
    if (source.lead > 1) held.temporal.skip = std::uint32_t(source.lead - 1);
    const Result<bool> more = take(held);
    if (!more || !*more) return more ? Result<void>() : more.error();
  }
  for (const fba::Plane& given : planes) {
    fba::Plane plane = given;
    plane.number += source.lead;
    const std::int64_t missing = std::max(source.frames, end) - plane.number - 1;
    if (&given == &planes.back() && missing > std::int64_t(plane.temporal.skip.value_or(0))) {
      plane.temporal.skip = std::uint32_t(missing);
    }
    const Result<bool> more = take(plane);
    if (!more || !*more) return more ? Result<void>() : more.error();
  }
  return {};
}

bool has_start_codes(const EditCut& cut) {
  const std::vector<fba::Plane>& planes = cut.source->motion.decoded.planes;
  return std::ranges::all_of(planes, [](const fba::Plane& plane) { return plane.start_code; });
}

}  // namespace

bool can_copy(const std::vector<EditCut>& cuts, fap::Rate rate) {
  return std::ranges::all_of(cuts, [&](const EditCut& cut) {
    const std::vector<fba::Plane>& planes = cut.source->motion.decoded.planes;
    return cut.source->coded() &&
           std::ranges::all_of(planes, [&](const fba::Plane& plane) { return plane.rate == rate; });
  });
}

Result<EditedPlanes> copy_planes(const std::vector<EditCut>& cuts, std::int64_t hold,
                                 bool start_codes) {
  start_codes = start_codes || std::ranges::all_of(cuts, has_start_codes);
  fba::Splicer splicer(
      {start_codes ? fba::PlaneStartCodes::all : fba::PlaneStartCodes::none, false});
  for (const EditCut& cut : cuts) {
    splicer.begin_source();
    const std::int64_t held = &cut == &cuts.front() ? hold : 0;
    auto copied = for_planes(*cut.source, cut.end, [&](const fba::Plane& plane) {
      return splicer.copy_frames(plane, cut.first, cut.end, held);
    });
    if (!copied) return copied.error().in_file(cut.source->path);
  }
  EditedPlanes edited;
  edited.stream = splicer.finish();
  edited.report = splicer.report();
  return edited;
}

std::vector<std::int64_t> intra_frames(const EditSource& source) {
  std::vector<std::int64_t> frames;
  if (source.lead > 0) frames.push_back(0);
  for (const fba::Plane& plane : source.motion.decoded.planes) {
    if (plane.intra) frames.push_back(plane.number + source.lead);
  }
  return frames;
}

}  // namespace animeme::tools
