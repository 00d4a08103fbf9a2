#include <algorithm>
#include <cstdlib>

#include "codec/encode/decide_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

// Largest level of an intra plane, and largest change of one from plane to plane.
std::int64_t limit_of(const Channel& channel, const Decision& decision) {
  return level_range(kMaxRange, scale_at(channel.body, decision.quant(channel)));
}

bool can_be_limited(const Channel& channel, const Row& row, const Decision& decision) {
  return row.role == Role::coded && decision.quant(channel) != 0;
}

}  // namespace

bool reaches_too_far(const ClipData& clip, const Decision& decision) {
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const Row& row = decision.rows[i];
    if (!can_be_limited(clip.channels[i], row, decision)) continue;
    const std::int64_t limit = limit_of(clip.channels[i], decision);
    if (std::any_of(row.levels.begin(), row.levels.end(),
                    [&](std::int32_t level) { return std::abs(std::int64_t(level)) > limit; })) {
      return true;
    }
  }
  return false;
}

std::size_t limit_levels(const ClipData& clip, const std::vector<std::size_t>& begins,
                         Decision& decision) {
  std::size_t limited = 0;
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    Row& row = decision.rows[i];
    if (!can_be_limited(clip.channels[i], row, decision)) continue;
    const std::int64_t limit = limit_of(clip.channels[i], decision);
    auto begin = begins.begin();
    for (std::size_t plane = 0; plane < row.levels.size(); ++plane) {
      const bool intra = begin != begins.end() && *begin == plane;
      if (intra) ++begin;
      const std::int64_t base = intra ? 0 : row.levels[plane - 1];
      const std::int64_t reached =
          std::clamp<std::int64_t>(row.levels[plane], base - limit, base + limit);
      limited += reached != row.levels[plane] ? 1 : 0;
      row.levels[plane] = std::int32_t(reached);
    }
  }
  return limited;
}

}  // namespace animeme::fba::internal
