// Choice of masks, ranges and quantisers, shared by the encoders of this folder.
// Not installed API.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <string>

#include "codec/syntax/plane.h"
#include "fap/result.h"

namespace animeme::fba::internal {

Error invalid(std::string message);  ///< Code::invalid_argument

/// Error invalid_argument if a quantiser, called `name`, is out of bounds.
Result<void> check_quant(const char* name, int quant);
/// The same for the numbers of an encoder's options.
Result<void> check_numbers(int fap_quant, int bap_quant, double intra_seconds);

/// Error out_of_range if FAP 1 or 2, where the mask of the frame has it, is out of its bounds:
/// visemes 0..14, expressions 0..6, blend and intensities 0..63.
Result<void> check_high_level(const fap::Frame& frame);

/// FAPs coded by mask types and masks; true if they agree (codec/bitstream.md, section 3.1).
bool mask_agrees(const FaceSettings& settings);
bool mask_agrees(const BodySettings& settings);

/// The mask type of each group from the mask; groups of which something is coded and something is
/// not become type 2 where `interpolated` says so (by group number - 1), else type 1.
void set_mask_types(FaceSettings& settings, std::bitset<fap::kGroupCount> interpolated = {});
void set_mask_types(BodySettings& settings);

/// Largest 5-bit range number: 31 * 60 = 1860 levels at scale 1.
inline constexpr int kMaxRange = 31;
/// Smallest range number m with m*60/scale >= level >= 0; more than kMaxRange if there is none.
inline int range_number(std::int64_t level, int scale) {
  return int(std::min<std::int64_t>((level * scale + 59) / 60, kMaxRange + 1));
}

/// The reference decoder takes an intra range of 0..0 for FAP 4 as "no ranges yet" and installs the
/// default ones (codec/bitstream.md, section 15.4). Never send that.
void guard_fap4(FaceSettings& settings);

/// If the last group of the body codes its first member alone, the 21 zeros of its mask, a gender
/// and a coding type of 0, and the 1 behind them are a false start code. Its last member is then
/// coded too, at 0.
void guard_last_group(std::bitset<kBapCount + 1>& mask);

}  // namespace animeme::fba::internal
