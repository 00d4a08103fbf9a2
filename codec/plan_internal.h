// Where the intra planes are and what they settle. Not installed API.
#pragma once

#include <vector>

#include "codec/decide_internal.h"

namespace animeme::fba::internal {

/// From an intra plane to the next.
struct Run {
  std::size_t first = 0;  // plane
  std::size_t count = 0;
  FaceSettings face;
  BodySettings body;
};

struct PlanOptions {
  int intra_period = 0;
  bool extra_intra = false;
  std::size_t detour = 0;  // > 0: another plan with the same values, for other bits
};

/// Planes in which something changes, the first and the last (indices, ascending).
std::vector<std::size_t> moving_planes(const ClipData& clip, const Decision& decision);

/// Error out_of_range if an intra plane cannot hold a value.
Result<std::vector<Run>> plan_runs(const ClipData& clip, const Decision& decision,
                                   const PlanOptions& options);

}  // namespace animeme::fba::internal
