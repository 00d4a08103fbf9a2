// Positions and settings of the intra planes. Not installed API.
#pragma once

#include <vector>

#include "codec/encode/decide_internal.h"

namespace animeme::fba::internal {

/// From an intra plane to the next.
struct Run {
  std::size_t first = 0;  // plane
  std::size_t count = 0;
  FaceSettings face;
  BodySettings body;
};

struct PlanOptions {
  std::int64_t intra_frames = 0;  // period_frames()
  bool extra_intra = false;
  // Planes whose bits held a hazard, ascending, one entry for each time: the runs that they are in
  // get other ranges for the same values, and so other bits.
  std::vector<std::size_t> hazardous;
  bool default_ranges = false;  // as EncodeOptions
};

/// Planes in which something changes, the first, the last, and so many in between that the rest can
/// be skipped (indices, ascending).
std::vector<std::size_t> moving_planes(const ClipData& clip, const Decision& decision);
/// Keeps these planes and drops the others.
void keep_planes(const std::vector<std::size_t>& planes, ClipData& clip, Decision& decision);

/// Indices of the channels that are coded, ascending: FAPs first.
std::vector<std::size_t> coded_channels(const Decision& decision);

/// The planes that are to be intra, ascending; the first is 0.
std::vector<std::size_t> run_begins(const ClipData& clip, const Decision& decision,
                                    const PlanOptions& options);

/// What the planes at `begins`, run_begins(), settle. Error out_of_range if an intra plane cannot
/// hold a value, or 32 bits its reconstruction.
Result<std::vector<Run>> plan_runs(const ClipData& clip, const Decision& decision,
                                   const std::vector<std::size_t>& begins,
                                   const PlanOptions& options);

}  // namespace animeme::fba::internal
