#include "codec/encode/decide_internal.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "codec/encode/rate_distortion_internal.h"

namespace animeme::fba::internal {

namespace {

// Parameters whose motion is too small to be seen stay at the middle of it.
void still_small_motion(const ClipData& clip, const EncodeOptions& options, Decision& decision) {
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const Channel& channel = clip.channels[i];
    const auto [low, high] = std::minmax_element(channel.value.begin(), channel.value.end());
    const double range = double(*high) - double(*low);
    if (range == 0 || range >= options.still_below * channel.unit) continue;
    double sum = 0;
    for (const std::int32_t value : channel.value) sum += value;
    const double mean = sum / double(channel.value.size());
    const std::int32_t step = step_at(channel, decision.quant(channel));
    decision.rows[i].levels.assign(clip.planes(), std::int32_t(std::lround(mean / step)));
  }
}

// The rows of the face by FAP numbers.
class FaceRows {
 public:
  FaceRows(const ClipData& clip, Decision& decision) {
    for (std::size_t i = 0; i < clip.channels.size(); ++i) {
      if (!clip.channels[i].body) rows_[std::size_t(clip.channels[i].number)] = &decision.rows[i];
    }
  }
  // Null if the clip does not have it.
  Row* operator[](int fap) const { return rows_[std::size_t(fap)]; }
  bool is(int fap, Role role) const {
    const Row* row = (*this)[fap];
    return row != nullptr && row->role == role;
  }

 private:
  std::array<Row*, fap::kFapCount + 1> rows_{};  // 0: no FAP
};

// A parameter that is not coded because it stays at 0 must not be given another value by a decoder
// that interpolates: the known one copies sides whatever the mask type says, others derive sides
// and lips in groups of type 2. Where that could happen the zeros are coded after all, which costs
// nothing but 20 bits of ranges an intra plane. A FAP that the clip does not have is not worth that
// except in a group that became type 2 because of other FAPs.
void guard_zeros(const ClipData& clip, Decision& decision) {
  const FaceRows rows(clip, decision);
  std::bitset<fap::kGroupCount + 1> interpolated;
  for (const fap::FapInfo& fap : fap::kFaps) {
    if (rows.is(fap.number, Role::mirrored)) interpolated.set(std::size_t(fap.group));
  }
  std::vector<Row*> guarded;
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const Channel& channel = clip.channels[i];
    if (channel.body || decision.rows[i].role != Role::left_out) continue;
    const fap::FapInfo& fap = fap::info(channel.number);
    const bool may_move = interpolated[std::size_t(fap.group)];
    bool endangered = (channel.given || may_move) && rows.is(fap.mirror, Role::coded);
    if (may_move && fap.partner != 0) {
      endangered |=
          rows.is(fap.partner, Role::coded) || rows.is(fap::info(fap.partner).mirror, Role::coded);
    }
    if (endangered) guarded.push_back(&decision.rows[i]);
  }
  for (Row* row : guarded) row->role = Role::coded;
}

void choose_roles(const ClipData& clip, Decision& decision) {
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    if (is_zero(decision.rows[i].levels)) decision.rows[i].role = Role::left_out;
  }
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const std::ptrdiff_t left = clip.channels[i].left;
    if (left < 0 || decision.rows[std::size_t(left)].role != Role::coded) continue;
    if (decision.rows[i].levels == decision.rows[std::size_t(left)].levels) {
      decision.rows[i].role = Role::mirrored;
    }
  }
  guard_zeros(clip, decision);
}

void mark_stilled(const ClipData& clip, Decision& decision) {
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    decision.rows[i].stilled =
        !is_still(clip.channels[i].value) && is_still(decision.rows[i].levels);
  }
}

}  // namespace

Decision decide(const ClipData& clip, const EncodeOptions& options, double bit_budget,
                SearchHint& hint) {
  Decision decision;
  decision.rows.resize(clip.channels.size());
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    if (!clip.channels[i].given) decision.rows[i].levels.assign(clip.planes(), 0);
  }
  decision.fap_quant = options.fap_quant;
  decision.bap_quant = options.bap_quant;
  if (options.max_rms > 0 || bit_budget > 0) {
    const RateDistortion search(clip, options);
    double bits = 0;
    // With a hint it is known that the error takes too many bits.
    const bool by_error = options.max_rms > 0 && hint.lambda == 0;
    if (by_error) bits = search.limit_error(options.max_rms, decision);
    if (bit_budget > 0 && (!by_error || bits > bit_budget)) {
      search.limit_bits(bit_budget, decision, hint);
    }
  } else {
    for (std::size_t i = 0; i < clip.channels.size(); ++i) {
      const Channel& channel = clip.channels[i];
      quantise_row(channel.value, step_at(channel, decision.quant(channel)),
                   decision.rows[i].levels);
    }
  }
  if (options.still_below > 0) still_small_motion(clip, options, decision);
  if (options.leave_out) choose_roles(clip, decision);
  mark_stilled(clip, decision);
  return decision;
}

}  // namespace animeme::fba::internal
