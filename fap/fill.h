// From coded frames, whose masks have gaps, to complete ones that any player can show.
#pragma once

#include <cstdint>

#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fap {

struct FillOptions {
  /// A side that was never sent takes the value of the other side (23 left/right pairs). Positive
  /// directions are mirrored by definition, so this is a copy.
  bool mirror = true;
  /// A lip contour that was never sent follows the other one (10 inner/outer pairs).
  bool lips = true;
  /// A FAP that is absent from a frame takes the value of its partner in the same frame even
  /// if it has an older value of its own. That is what mask type 2 of the bitstream means; false
  /// holds the older value as types 0 and 1 mean. Text files do not say which.
  bool prefer_partner = false;
  /// Frames that were skipped: values between their neighbours, rounded (true), or those of the
  /// frame before (false, what a receiver shows).
  bool interpolate = false;
  /// Keep FAP 1 and 2 beside low-level FAPs. Known players disagree about such frames, so they
  /// are left out as long as there is anything else.
  bool keep_high_level = false;
  /// Most frames that the result may have: skipped frames cost memory, about 380 bytes each.
  std::int64_t max_frames = 1'000'000;
};

/// Fills `sequence`: the result has the frame numbers 0, 1, 2 ... up to the last one, and the same
/// mask in each frame: all FAPs that were ever sent and those that follow from them.
///
/// The rules in their order, by mask and never by "the value is 0" (which would move the other
/// side of a face that rests on purpose): the value in the frame; the last value sent; for a FAP
/// never sent so far the other side, then the other lip contour, then the other side of that;
/// 0 (neutral). Held visemes and expressions lose their `def` and `init_face` flags, which are
/// events. Source: fap_semantics, section 6; a table sent in the scene (FIT) is not known here.
///
/// Errors: Code::invalid_argument if the frame numbers are negative or do not ascend;
/// Code::out_of_range if the result would have more than max_frames frames.
Result<Sequence> fill(const Sequence& sequence, const FillOptions& options = {});

}  // namespace animeme::fap
