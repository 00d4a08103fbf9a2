// The clip data of an encoder: one row of values for each parameter. Not installed API.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/syntax/plane.h"
#include "codec/syntax/quantise_internal.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba::internal {

/// One low-level FAP or BAP over all planes.
struct Channel {
  bool body = false;
  bool given = true;         // false: no frame of the clip has it
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

/// How many frames of `rate` an intra period lasts, at least one; 0: there is none.
std::int64_t period_frames(double intra_seconds, fap::Rate rate);
/// Where a stretch of planes gets intra planes because the period is over: `first`, then each plane
/// that stands so many frames (> 0) behind the last one. Frames that are skipped count.
void add_periods(std::span<const std::int64_t> number, std::size_t first, std::size_t end,
                 std::int64_t frames, std::vector<std::size_t>& begins);

/// Whether a frame can follow another one: at most a million frames are skipped in a row. Error:
/// invalid_argument.
Result<void> check_step(std::int64_t number, std::int64_t next);

/// Merges face and body by frame numbers and holds what a frame leaves out. `leave_out`: a face
/// gets channels, at 0, of the low-level FAPs that it does not have, too, and what rests throughout
/// is left out as far as that is known before levels are chosen. Errors as encode().
Result<ClipData> gather(const fap::Sequence& face, std::span<const BodyFrame> body, bool leave_out);

/// Quantiser step of a channel at fap_quant or the body quantiser index.
inline std::int32_t step_at(const Channel& channel, int quant) {
  return step_at(channel.body, channel.step, quant);
}

/// Whether it stays at its first value.
inline bool is_still(std::span<const std::int32_t> row) {
  return std::all_of(row.begin(), row.end(), [&](std::int32_t v) { return v == row.front(); });
}
/// Whether it rests at 0.
inline bool is_zero(std::span<const std::int32_t> row) { return row.front() == 0 && is_still(row); }

/// What the plain quantiser makes of a row: levels of the reconstruction, that is values divided
/// by `step`, each within half a step and nearest to the one before.
void quantise_row(std::span<const std::int32_t> value, std::int32_t step,
                  std::vector<std::int32_t>& levels);

}  // namespace animeme::fba::internal
