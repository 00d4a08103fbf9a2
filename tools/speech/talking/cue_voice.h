/// @file
/// Subtitles spoken by a voice, synthetic or recorded, each in its time: a translation fitted to a
/// film.
///
///     auto fitted = fit_cues(cues, speak, {});
///     fitted->speech.audio;          // from 0 to the end of the last cue
///     fitted->cues[3].cut;           // characters by which the fourth is too long
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dam/script/timings.h"
#include "fap/result.h"
#include "tools/speech/voice/align.h"
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
  /// Of a recorded voice: mean over its words, 0..1. nullopt: a synthetic voice, or no word of it
  /// is known to be said.
  std::optional<double> confidence = std::nullopt;
};

/// Result of fit_cues().
struct FittedSpeech {
  voice::Speech speech;         ///< all cues, with silence between them
  std::vector<FittedCue> cues;  ///< in order
};

/// A part of a sound with its phones, from 0 on, at another speed and the same pitch
/// (media/stretch.h). `start`, `end`: seconds; `speed`: 0.05..20.
voice::Speech stretched_part(const media::Pcm& audio, const dam::Script& script, double start,
                             double end, double speed);

/// Speaks a cue, counted from 0, at a share of the usual speed, without silence around it.
using SpeakAtSpeed = std::function<Result<voice::Speech>(std::size_t cue, double speed)>;

/// Receives the sound piece by piece, with its rate; an error ends the work.
using TakeSound = std::function<Result<void>(std::span<const float> samples, int sample_rate)>;

/// Speaks each cue in its time. What is shorter than its time is said more slowly, down to the
/// range. What is longer loses first of its pauses (of all above 0.06 s as much as needed), then it
/// is said faster, up to the range. What is too long even then is not cut: it ends late, at the
/// cost of the pause behind it, and moves the next one if that is not enough; `late` and `cut` tell
/// of it. Errors: invalid_argument (no cues, cues that do not ascend, the range), out_of_range
/// (more than a day), those of `speak`, with the number of the cue, and of `take`. With `take` the
/// sound goes there, and FittedSpeech::speech has none.
Result<FittedSpeech> fit_cues(const std::vector<Cue>& cues, const SpeakAtSpeed& speak,
                              const FitRange& range = {}, const TakeSound& take = {});

/// Where a recording says a cue.
struct RecordedCue {
  double start = 0;                                 ///< seconds
  double end = 0;                                   ///< seconds; `start`: it is not said
  std::optional<double> confidence = std::nullopt;  ///< as FittedCue::confidence
};

/// Where an aligned recording says each cue. `words` are those of `texts`, one after the other, as
/// voice::Alignment::words; a word belongs to the text in which it is found next.
std::vector<RecordedCue> find_cues(std::span<const std::string> texts,
                                   std::span<const voice::AlignedWord> words);

/// What fit_recording() made.
struct FittedRecording {
  std::vector<FittedCue> cues;  ///< in order
  /// The new sound, with silence between the cues; nullopt: the recording has every cue in its time
  /// and stays as it is.
  std::optional<voice::Speech> speech;
};

/// Puts the parts of a recorded voice into the times of their cues, if one of them is elsewhere: it
/// begins more than 0.15 s too early or ends more than 0.1 s too late. Parts that are in their time
/// stay where they are; others begin with their cue, lose of their pauses and are stretched at the
/// same pitch as fit_cues() does, but never slowed down. `script`: the phones of the recording.
/// Errors: those of fit_cues(); invalid_argument (not as many `said` as `cues`).
Result<FittedRecording> fit_recording(const std::vector<Cue>& cues,
                                      std::span<const RecordedCue> said, const media::Pcm& audio,
                                      const dam::Script& script, const FitRange& range = {});

/// The cues of subtitles: labels that are words, those of one line of the file together. Errors:
/// unsupported (labels are phones, or there are none).
Result<std::vector<Cue>> cues_of(const dam::Timings& timings);

}  // namespace animeme::speech
