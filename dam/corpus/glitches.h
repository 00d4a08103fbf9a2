/// @file
/// Trackers slip: a channel jumps for some frames, spikes for one, or holds its last value. Least
/// squares would bend a model to such values, so they are taken out before anything is learned.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"

namespace animeme::dam {

/// What was wrong with some frames of a control.
enum class GlitchKind : std::uint8_t {
  jump,   ///< far beyond what the control does otherwise
  spike,  ///< one frame far off both its neighbours
  stuck,  ///< the same value for 0.3 s or more in a control that hardly ever repeats one
};
/// "jump", "spike", "stuck".
const char* glitch_name(GlitchKind kind);

/// Frames of one control of one sentence that cannot be what the face did.
struct Glitch {
  std::string id;                      ///< of the sentence
  std::string control;                 ///< the channel
  GlitchKind kind = GlitchKind::jump;  ///< what is wrong
  std::size_t first = 0;               ///< frame
  std::size_t frames = 0;              ///< so many from there
  double time = 0;                     ///< seconds of the first
  /// Up to 0.12 s, as with Bridges::build: a straight line is in its place. Else its frames do not
  /// count as measured.
  bool bridged = false;
};

/// "sentence 's1': jawOpen is stuck from 1.20 s, 10 frames; left out".
std::string describe(const Glitch& glitch);

/// Sentences with their glitches taken out. Those without are borrowed.
struct Mended {
  std::vector<const Utterance*> sentences;         ///< as given
  std::vector<std::unique_ptr<Utterance>> copies;  ///< of those that had some
  std::vector<Glitch> glitches;                    ///< by sentence, control and time
};

/// What is done with short glitches.
enum class Bridges : std::uint8_t {
  build,  ///< a straight line in their place, which counts as measured: to learn from
  none,   ///< as with long ones, their frames do not count: to score by
};

/// Looks for glitches, measured by how each control moves in all the sentences together, and takes
/// them out. Nothing is done to sentences whose controls or rates differ or that have values that
/// are no numbers. Their order does not matter. Definitions:
///
/// - the usual span of a control is from its 5th to its 95th percentile (of less than 12 s of
///   material further in, so that 0.6 s of nonsense cannot be usual);
/// - jump: beyond the middle by three such spans (four if there is less than 12 s), and beyond the
///   natural limits of the control, if it has some (limits.h), with up to three frames on either
///   side that are beyond it by one;
/// - spike: off the mean of its neighbours by the usual span and by three times what 99.5 % of the
///   frames are, while these are alike;
/// - stuck: in speech, 0.3 s of one value that is no habit of the control (1 % of its other
/// frames),
///   if it repeats values, for less than that, in under 10 % of the frames of speech.
///
/// A control with glitches in more than 5 % of its frames, and 0.6 s, is like that; nothing is
/// taken out of it.
Mended mend_glitches(std::span<const Utterance* const> sentences, Bridges bridges = Bridges::build);

}  // namespace animeme::dam
