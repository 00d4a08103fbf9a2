// Decides which parameters of a clip are coded, with which quantiser and levels. Not installed API.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "codec/encode/clip_internal.h"
#include "codec/encode/encode.h"

namespace animeme::fba::internal {

enum class Role : std::uint8_t {
  coded,
  mirrored,  // the right side of a pair, taken from its left side by the decoder
  left_out,  // stays at 0
};

/// The coding decision for one channel.
struct Row {
  Role role = Role::coded;
  bool stilled = false;              // moves in the clip and not here
  std::vector<std::int32_t> levels;  // of the reconstruction: value / step
};

/// Quantisers of one plane and its levels, one for each channel.
struct CoarsePlane {
  int fap_quant = 1;
  int bap_quant = 1;
  std::vector<std::int32_t> levels;

  int quant(const Channel& channel) const { return channel.body ? bap_quant : fap_quant; }
};

struct Decision {
  int fap_quant = 1;
  int bap_quant = 1;
  std::vector<Row> rows;  // one for each channel of the clip
  // The first plane, if it defines the ranges of all others in finer steps than theirs
  // (EncodeOptions::kept_ranges).
  std::optional<CoarsePlane> first;

  int quant(const Channel& channel) const { return channel.body ? bap_quant : fap_quant; }
  /// The value that a decoder has of channel `i`, which is `channel`.
  std::int64_t value(const Channel& channel, std::size_t i, std::size_t plane) const {
    if (first && plane == 0) {
      return std::int64_t(first->levels[i]) * step_at(channel, first->quant(channel));
    }
    return std::int64_t(rows[i].levels[plane]) * step_at(channel, quant(channel));
  }
};

/// Gives the decision a first plane at the quantisers with which the ranges of all predictive
/// planes cost least. Leaves it as it is where that cannot save anything.
void choose_first(const ClipData& clip, Decision& decision);

/// True if a level lies beyond what an intra plane can hold. Never without quantisation, where
/// angles could not be followed at all: that is an error.
bool reaches_too_far(const ClipData& clip, const Decision& decision);
/// Replaces levels that cannot be reached, with intra planes at `begins` (ascending), by the
/// nearest that can. Returns how many.
std::size_t limit_levels(const ClipData& clip, const std::vector<std::size_t>& begins,
                         Decision& decision);

/// Where a search for a number of bits ended, for one that looks for another number.
struct SearchHint {
  double bits = 0;             // that it ended at
  double lambda = 0;           // 0: there is none
  std::array<int, 2> quant{};  // of the face and the body, those that there are
};

/// The decision that `options` ask for. `bit_budget`: bits for the parameters of the whole clip
/// (without headers), 0: any number. `hint`: of the same clip with another budget, or none yet.
Decision decide(const ClipData& clip, const EncodeOptions& options, double bit_budget,
                SearchHint& hint);

}  // namespace animeme::fba::internal
