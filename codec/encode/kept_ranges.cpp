#include <algorithm>
#include <limits>

#include "codec/encode/code_length_internal.h"
#include "codec/encode/decide_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

constexpr int kCoarsest = 31;  // both quantisers are 5-bit numbers
constexpr Bits kTooWide = std::numeric_limits<Bits>::max();

// The differences of one parameter that predictive planes have to code; larger ones make intra
// planes.
struct Changes {
  Histogram histogram;
  std::int32_t low = 0;
  std::int32_t high = 0;
};

Changes changes_of(std::span<const std::int32_t> levels, int scale) {
  const std::int64_t limit = level_range(kMaxRange, scale);
  Changes changes;
  for (std::size_t plane = 2; plane < levels.size(); ++plane) {
    const std::int64_t change = std::int64_t(levels[plane]) - levels[plane - 1];
    if (std::abs(change) > limit) continue;
    changes.low = std::min(changes.low, std::int32_t(change));
    changes.high = std::max(changes.high, std::int32_t(change));
  }
  changes.histogram.count(levels.subspan(1), changes.low, changes.high);
  return changes;
}

// What the changes of all parameters cost with ranges in the steps of a scale.
Bits cost(const std::vector<Changes>& all, int scale) {
  Bits bits = 0;
  for (const Changes& changes : all) {
    const int up = range_number(changes.high, scale);
    const int down = range_number(-std::int64_t(changes.low), scale);
    if (std::max(up, down) > kMaxRange) return kTooWide;
    bits += changes.histogram.bits(
        std::uint32_t(level_range(up, scale) + level_range(down, scale) + 1));
  }
  return bits;
}

int cheapest_quant(const ClipData& clip, const Decision& decision, bool body) {
  const int own = body ? decision.bap_quant : decision.fap_quant;
  std::vector<Changes> all;
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    if (clip.channels[i].body != body || decision.rows[i].role != Role::coded) continue;
    all.push_back(changes_of(decision.rows[i].levels, scale_at(body, own)));
  }
  int best = own;
  Bits least = cost(all, scale_at(body, own));
  for (int quant = own + 1; quant <= kCoarsest; ++quant) {
    const Bits bits = cost(all, scale_at(body, quant));
    if (bits >= least) continue;
    least = bits;
    best = quant;
  }
  return best;
}

}  // namespace

void choose_first(const ClipData& clip, Decision& decision) {
  if (clip.planes() < 3) return;
  CoarsePlane first;
  first.fap_quant = cheapest_quant(clip, decision, false);
  first.bap_quant = cheapest_quant(clip, decision, true);
  if (first.fap_quant == decision.fap_quant && first.bap_quant == decision.bap_quant) return;
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const Channel& channel = clip.channels[i];
    const int quant = first.quant(channel);
    const std::int64_t limit = level_range(kMaxRange, scale_at(channel.body, quant));
    const std::int64_t level = quantise(decision.value(channel, i, 0), step_at(channel, quant));
    first.levels.push_back(std::int32_t(std::clamp(level, -limit, limit)));
  }
  decision.first = std::move(first);
}

}  // namespace animeme::fba::internal
