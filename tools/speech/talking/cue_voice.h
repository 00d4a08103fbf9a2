/// @file
/// Subtitles spoken by a voice, each in its time: a translation fitted to a film.
///
///     auto fitted = fit_cues(cues, speak, {});
///     fitted->speech.audio;          // from 0 to the end of the last cue
///     fitted->cues[3].cut;           // characters by which the fourth is too long
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "dam/script/timings.h"
#include "fap/result.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {

/// One subtitle.
struct Cue {
  double start = 0;  ///< seconds
  double end = 0;    ///< seconds, > start
  std::string text;  ///< what is said
};

/// The speed of a voice, as a share of its usual one.
struct FitRange {
  double slowest = 0.8;  ///< 0.5..1
  double fastest = 1.3;  ///< 1..2
  friend bool operator==(const FitRange&, const FitRange&) = default;
};

/// Reads "0.8-1.3". Errors: invalid_argument.
Result<FitRange> parse_fit_range(const std::string& text);

/// What became of a cue.
struct FittedCue {
  Cue cue;             ///< as it was
  double start = 0;    ///< when it is said, seconds; later than wanted behind one that is too long
  double seconds = 0;  ///< how long it lasts
  double speed = 1;    ///< of the voice, within the range
  double shortened = 0;  ///< seconds taken from pauses in it
  double late = 0;       ///< seconds by which it ends behind its time
  std::size_t cut = 0;   ///< characters to cut, so that it fits; 0: it does
};

/// Result of fit_cues().
struct FittedSpeech {
  voice::Speech speech;         ///< all cues, with silence between them
  std::vector<FittedCue> cues;  ///< in order
};

/// Speaks a text at a share of the usual speed, without silence around it.
using SpeakAtSpeed = std::function<Result<voice::Speech>(const std::string& text, double speed)>;

/// Speaks each cue in its time. What is shorter than its time is said more slowly, down to the
/// range. What is longer loses first of its pauses (of all above 0.06 s as much as needed), then it
/// is said faster, up to the range. What is too long even then is not cut: it ends late, at the
/// cost of the pause behind it, and moves the next one if that is not enough; `late` and `cut` tell
/// of it. Errors: invalid_argument (no cues, cues that do not ascend, the range), out_of_range
/// (more than a day), those of `speak`, with the number of the cue.
Result<FittedSpeech> fit_cues(const std::vector<Cue>& cues, const SpeakAtSpeed& speak,
                              const FitRange& range = {});

/// The cues of subtitles: labels that are words, those of one line of the file together. Errors:
/// unsupported (labels are phones, or there are none).
Result<std::vector<Cue>> cues_of(const dam::Timings& timings);

}  // namespace animeme::speech
