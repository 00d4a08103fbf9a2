/// @file
/// Idle motion of a clip: what a face does besides speaking, by dam/behaviour. For models that have
/// the mouth only. Off in evaluation.
///
/// - Gaze: eye contact and looks away, saccades and micro-saccades; eyes turn against the head, and
///   lids follow them. Utterances often begin with a look away and end with eye contact.
/// - Head: shifts of posture, the motion of a head that speaks, nods at accents, a tilt at
///   questions, breath; with `prosody` also what follows the pitch of the voice.
/// - Brows rise at accents and questions, and frown now and then; cheeks and nostrils move a
///   little.
/// - Blinks: some half, some double, more at the ends of phrases and with large gaze shifts.
///
/// Head and brows begin and end at rest. All is drawn from a seeded generator, so that a clip is
/// always the same, and clips with other seeds differ. dam/behaviour/README.md has the statistics.
#pragma once

#include <cstddef>
#include <cstdint>

#include "dam/behaviour/behaviour.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "dam/speaking/conversation.h"
#include "fap/result.h"

namespace animeme::dam {

/// Options of add_idle_motion().
struct IdleMotionOptions {
  double liveliness = 1;             ///< 0..2; 0: only what the text asks for, brows at questions
  std::uint64_t seed = 1;            ///< another seed, other motion
  StillParts still = {};             ///< parts that do not move
  Look look = {};                    ///< where the eyes look
  const Prosody* prosody = nullptr;  ///< of the voice, from the start of the script; may be null
  /// Of somebody who talks to others: in place of `look`; null: nobody else is there.
  const Attention* attention = nullptr;
};

/// Result of add_idle_motion().
using IdleMotionReport = BehaviourCounts;

/// Adds channels for FAP 19 to 26 (lids and eyes), 31 to 38 (brows), 41, 42 (cheeks), 48 to 50
/// (head), 61 and 62 (nostrils) to a signal of FAPs, in FAP units. Channels that the signal already
/// has stay as they are; those of parts that are still are not added. With liveliness 0 nothing is
/// added but FAP 31 to 36 (browInnerUp, browOuterUp) to a clip that has a question.
///
/// A signal of ARKit shapes gets eyeBlink, eyeLook (in, out, up, down), browOuterUp, browDown and
/// cheekSquint of both sides, browInnerUp, and headYaw, headPitch and headRoll (radians), in the
/// spelling of its own channels. It often has some of these already, learned from speech, without
/// blinks: then lids close by the larger of both values, brows and cheeks move by the sum, at most
/// to 1; eyeWide is reduced; existing channels of gaze and head stay as they are.
///
/// The signal must begin at frame 0. Errors: invalid_argument (liveliness out of range, a part of a
/// stream), unsupported (the signal has neither FAPs nor ARKit shapes).
Result<IdleMotionReport> add_idle_motion(Signal& signal, const Script& script,
                                         const IdleMotionOptions& options = {});

}  // namespace animeme::dam
