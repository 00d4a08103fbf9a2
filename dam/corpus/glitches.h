/// @file
/// Detects tracking errors: a channel jumps for some frames, spikes for one, or repeats its last
/// value. Least squares would fit a model to such values, so they are removed before training.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"

namespace animeme::dam {

/// Kind of error in some frames of a control.
enum class GlitchKind : std::uint8_t {
  jump,   ///< far beyond the usual range of the control
  spike,  ///< one frame far from both its neighbours
  stuck,  ///< the same value for 0.3 s or more in a control that hardly ever repeats one
};
/// "jump", "spike", "stuck".
const char* glitch_name(GlitchKind kind);

/// Frames of one control of one sentence that cannot be real motion.
struct Glitch {
  std::string id;                      ///< of the sentence
  std::string control;                 ///< the channel
  GlitchKind kind = GlitchKind::jump;  ///< see GlitchKind
  std::size_t first = 0;               ///< first frame
  std::size_t frames = 0;              ///< number of frames
  double time = 0;                     ///< of the first frame, seconds
  /// True for glitches of up to 0.12 s with ShortGlitches::interpolate: they are interpolated
  /// linearly. False: their frames do not count as measured.
  bool bridged = false;
};

/// "sentence 's1': jawOpen is stuck from 1.20 s, 10 frames; left out".
std::string describe(const Glitch& glitch);

/// Sentences with their glitches removed. Those without glitches are borrowed.
struct CleanedSentences {
  std::vector<const Utterance*> sentences;         ///< as given
  std::vector<std::unique_ptr<Utterance>> copies;  ///< of those with glitches
  std::vector<Glitch> glitches;                    ///< by sentence, control and time
};

/// Treatment of short glitches.
enum class ShortGlitches : std::uint8_t {
  interpolate,  ///< interpolated linearly and counted as measured: for training
  omit,         ///< like long ones, their frames do not count: for scoring
};

/// Detects glitches, relative to the usual motion of each control in all the sentences, and removes
/// them. Sentences with different controls or rates or with values that are not finite are
/// unchanged. The order of the sentences does not matter. Definitions:
///
/// - the usual span of a control is from its 5th to its 95th percentile (of less than 12 s of data
///   further in, so that 0.6 s of errors cannot be usual);
/// - jump: away from the middle by three such spans (four if there is less than 12 s), and beyond
///   the natural limits of the control, if it has any (limits.h), with up to three frames on either
///   side that are beyond it by one span;
/// - spike: away from the mean of its neighbours by the usual span and by three times what 99.5 %
///   of the frames are, while the neighbours are alike;
/// - stuck: in speech, 0.3 s of one value that the control does not take often (1 % of its other
///   frames), if under 10 % of the frames of speech are shorter repetitions of a value.
///
/// Nothing is removed from a control with glitches in more than 5 % of its frames, and 0.6 s: that
/// is its normal behaviour.
CleanedSentences remove_glitches(std::span<const Utterance* const> sentences,
                                 ShortGlitches short_glitches = ShortGlitches::interpolate);

}  // namespace animeme::dam
