// A clip as an encoder sees it: one row of values for each parameter. Not installed API.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/plane.h"
#include "codec/quantise_internal.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba::internal {

/// One low-level FAP or BAP over all planes.
struct Channel {
  bool body = false;
  bool distance = true;      // a FAP that is no angle
  int number = 0;            // FAP or BAP number
  std::int32_t step = 1;     // quantiser step at quantiser 1
  double unit = 1;           // size of an error that counts as 1
  std::ptrdiff_t left = -1;  // index of the left side if this is the right side of a pair
  std::vector<std::int32_t> value;
};

/// Planes in order; every parameter that occurs is present in each of them.
struct ClipData {
  CodedRate rate;
  bool has_face = false;
  bool has_body = false;
  bool has_viseme = false;
  bool has_expression = false;
  std::vector<std::int64_t> number;  // of the planes, ascending
  std::vector<fap::Viseme> viseme;   // a row each if present
  std::vector<fap::Expression> expression;
  std::vector<Channel> channels;  // FAPs ascending, then BAPs in coding order

  std::size_t planes() const { return number.size(); }
};

/// Merges face and body by frame numbers and holds what a frame leaves out. Errors as encode().
Result<ClipData> gather(const fap::Sequence& face, std::span<const BodyFrame> body);

/// Quantiser step of a channel at fap_quant or the body quantiser index.
inline std::int32_t step_at(const Channel& channel, int quant) {
  if (quant == 0) return 1;
  return channel.step * (channel.body ? bap_scale(quant) : fap_scale(quant));
}
/// Divisor of the ranges.
inline int scale_at(bool body, int quant) { return body ? bap_scale(quant) : fap_scale(quant); }

/// Largest 5-bit range number: 31 * 60 = 1860 levels at scale 1.
inline constexpr int kMaxRange = 31;
/// Smallest range number m with m*60/scale >= level >= 0; more than kMaxRange if there is none.
inline int range_number(std::int64_t level, int scale) {
  return int(std::min<std::int64_t>((level * scale + 59) / 60, kMaxRange + 1));
}

/// The reference decoder takes an intra range of 0..0 for FAP 4 as "no ranges yet" and installs the
/// default ones (fba_bitstream, 15.4). Never send that.
inline void guard_fap4(FaceSettings& settings) {
  const bool zero = settings.range[kIntraMax][4] == 0 && settings.range[kIntraMin][4] == 0;
  if (settings.mask[4] && zero) settings.range[kIntraMax][4] = 1;
}

/// If the last group of the body codes its first member alone, the 21 zeros of its mask, a gender
/// and a coding type of 0, and the 1 behind them are a false start code. Its last member is then
/// coded too, at 0.
inline void guard_last_group(std::bitset<kBapCount + 1>& mask) {
  const auto group = std::span(kBapOrder).last(kBodyGroupSizes.back());
  const auto coded =
      std::count_if(group.begin(), group.end(), [&](int bap) { return mask[std::size_t(bap)]; });
  if (coded == 1 && mask[group.front()]) mask.set(group.back());
}

/// The multiple of the quantiser that is coded for a blend or an intensity: the nearest one that is
/// not above 63, which is all that they may be. Values out of 0..63 stay, to be refused.
inline void keep_legal(std::int32_t& value, int fap_quant) {
  if (value < 0 || value > 63) return;
  const std::int32_t step = fap_scale(fap_quant);
  value = std::int32_t(quantise(value, step)) * step;
  if (value > 63) value -= step;
}
inline void keep_legal(fap::Viseme& viseme, fap::Expression& expression, int fap_quant) {
  keep_legal(viseme.blend, fap_quant);
  keep_legal(expression.intensity1, fap_quant);
  keep_legal(expression.intensity2, fap_quant);
}

/// What the plain quantiser makes of a row: levels of the reconstruction, that is values divided
/// by `step`, each within half a step and nearest to the one before.
void quantise_row(std::span<const std::int32_t> value, std::int32_t step,
                  std::vector<std::int32_t>& levels);

}  // namespace animeme::fba::internal
