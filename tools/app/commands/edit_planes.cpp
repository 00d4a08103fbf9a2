#include "tools/app/commands/edit_planes.h"

#include <algorithm>

namespace animeme::tools {
namespace {

// The planes of a source on its own time line: the first pose is held from its beginning, the last
// one up to frame `end`.
std::vector<fba::Plane> planes_on_time_line(const EditSource& source, std::int64_t end) {
  std::vector<fba::Plane> planes;
  const std::vector<fba::Plane>& coded = source.motion.decoded.planes;
  if (source.lead > 0) {
    planes.push_back(coded.front());
    planes.back().number = -source.lead;
    planes.back().temporal.skip.reset();
    if (source.lead > 1) planes.back().temporal.skip = std::uint32_t(source.lead - 1);
  }
  planes.insert(planes.end(), coded.begin(), coded.end());
  for (fba::Plane& plane : planes) plane.number += source.lead;
  fba::Plane& last = planes.back();
  const std::int64_t missing = std::max(source.frames, end) - last.number - 1;
  if (missing > std::int64_t(last.temporal.skip.value_or(0))) {
    last.temporal.skip = std::uint32_t(missing);
  }
  return planes;
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
    for (const fba::Plane& plane : planes_on_time_line(*cut.source, cut.end)) {
      const auto more =
          splicer.copy_frames(plane, cut.first, cut.end, &cut == &cuts.front() ? hold : 0);
      if (!more) return more.error().in_file(cut.source->path);
      if (!*more) break;
    }
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
