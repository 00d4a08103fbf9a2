/// @file
/// Idle motion around a talking mouth: blinks, brows that rise and a head that nods at stresses,
/// a head that is never quite still. Not learned but made by rule, for models that have the mouth
/// alone. Off in evaluation.
///
/// - Blinks: one as a pause of 0.25 s or more begins, and otherwise every 2 to 6 s, never two
/// within
///   1 s. The lids close in 80 ms, stay for 40 ms and open in 160 ms.
/// - Accents: in every stretch of speech the vowel that is drawn out most, and each other vowel 1.4
///   times longer than the median vowel of the script, at least 0.6 s apart. The brows rise by
///   about 3 mm and the head nods by 1.5 degrees (half as much for all but the first kind),
///   beginning 150 ms before the vowel, largest at its middle, gone 350 ms after.
/// - Drift: slow sines of less than 1 degree in pitch, yaw and roll, from nothing at both ends.
///
/// The times come from a small generator with a seed, so that a clip is always the same.
#pragma once

#include <cstddef>
#include <cstdint>

#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// How lively a face is made.
struct IdleMotionOptions {
  double amount = 1;       ///< scales brows and head, 0..2; lids always close
  std::uint64_t seed = 1;  ///< another seed, other times of blinks and another drift
};

/// What add_idle_motion() added.
struct IdleMotionReport {
  std::size_t blinks = 0;   ///< lids that closed
  std::size_t accents = 0;  ///< vowels with a gesture
};

/// Adds channels for FAP 19 to 22 (lids), 31 to 36 (brows) and 48 to 50 (head) to a signal of FAPs,
/// in FAP units. Channels that the signal already has are the character's own and stay as they are.
///
/// A signal of ARKit's shapes gets eyeBlink of both sides, browInnerUp, browOuterUp of both sides,
/// and headYaw, headPitch and headRoll (radians), spelled as its own channels are. Of these it
/// often has all, learned from speech, which knows nothing of blinks: lids close as far as one of
/// the two wants, brows rise by the sum, at most to 1; eyeWide gives way; a head of its own stays
/// as it is.
///
/// The signal must begin at frame 0. Errors: invalid_argument (amount out of range, a piece of a
/// stream), unsupported (the signal has neither FAPs nor shapes of ARKit: the names of another rig
/// are not known).
Result<IdleMotionReport> add_idle_motion(Signal& signal, const Script& script,
                                         const IdleMotionOptions& options = {});

}  // namespace animeme::dam
