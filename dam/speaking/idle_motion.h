/// @file
/// Idle motion around a talking mouth: blinks, brows that rise and a head that nods at stresses, a
/// head that is never quite still. By rule, not learned, for models that have the mouth only. Off
/// in evaluation.
///
/// - Blinks: one at the start of a pause of 0.25 s or more, and otherwise every 2 to 6 s, never two
///   within 1 s. The lids close in 80 ms, stay for 40 ms and open in 160 ms.
/// - Accents: in every stretch of speech the most lengthened vowel, and each other vowel 1.4 times
///   longer than the median vowel of the script, at least 0.6 s apart. The brows rise by about 3 mm
///   and the head nods by 1.5 degrees (half as much for all but the first kind), beginning 150 ms
///   before the vowel, largest at its middle, gone 350 ms after.
/// - Drift: slow sines of less than 1 degree in pitch, yaw and roll, fading to zero at both ends.
///
/// The times come from a small seeded generator, so that a clip is always the same.
#pragma once

#include <cstddef>
#include <cstdint>

#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// Options of add_idle_motion().
struct IdleMotionOptions {
  double amount = 1;       ///< scales brows and head, 0..2; lids always close
  std::uint64_t seed = 1;  ///< changes the times of blinks and the drift
};

/// Result of add_idle_motion().
struct IdleMotionReport {
  std::size_t blinks = 0;   ///< lids that closed
  std::size_t accents = 0;  ///< vowels with a gesture
};

/// Adds channels for FAP 19 to 22 (lids), 31 to 36 (brows) and 48 to 50 (head) to a signal of FAPs,
/// in FAP units. Channels that the signal already has stay as they are.
///
/// A signal of ARKit shapes gets eyeBlink of both sides, browInnerUp, browOuterUp of both sides,
/// and headYaw, headPitch and headRoll (radians), in the spelling of its own channels. It often has
/// these already, learned from speech, without blinks: then lids close by the larger of both
/// values, brows rise by the sum, at most to 1; eyeWide is reduced; existing head channels stay as
/// they are.
///
/// The signal must begin at frame 0. Errors: invalid_argument (amount out of range, a part of a
/// stream), unsupported (the signal has neither FAPs nor ARKit shapes).
Result<IdleMotionReport> add_idle_motion(Signal& signal, const Script& script,
                                         const IdleMotionOptions& options = {});

}  // namespace animeme::dam
