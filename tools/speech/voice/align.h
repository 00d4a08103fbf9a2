/// @file
/// Forced alignment: finds when each phone of a known text is spoken in a recording.
///
/// The recogniser is pocketsphinx with its US English model (Debian packages libpocketsphinx-dev to
/// build, pocketsphinx-en-us to run; BSD-style licences), an optional part of the build
/// (ANIMEME_WITH_ALIGNER). English words are looked up in its dictionary; unknown words and all
/// words of other languages get their phones from espeak-ng (see voice.h) and are then aligned with
/// the English model: less exact, but sufficient for lips.
/// Source: tools/speech/voice/engines.md, section 1.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::voice {

/// Language and data of the recogniser.
struct AlignOptions {
  std::string language = "en";  ///< of the transcript, as in VoiceOptions::language
  /// Folder of the acoustic model (with mdef, means ...).
  std::string model_path = "/usr/share/pocketsphinx/model/en-us/en-us";
  /// Pronunciations: lines "word PH PH ...", variants as "word(2) ...". Used for English only.
  std::string dictionary_path = "/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict";
  /// Overall confidence (Alignment::confidence), 0..1, that needs no second look. Below, texts that
  /// nobody said are aligned as well: a transcript that fits no better than they do is rejected,
  /// such as a wrong one, noise, or silence; one that does is accepted with a warning. 0: accept
  /// everything.
  double least_confidence = 0.5;
};

/// A word of the transcript with its position.
struct AlignedWord {
  std::string text;  ///< as in the transcript
  double start = 0;  ///< seconds
  double end = 0;    ///< seconds; `start` if it is not said
  /// How well the sound fits, 0..1, compared with the best unconstrained phones. For whole
  /// recordings, correct and wrong texts are equally likely at 0.5; a single short word may be
  /// correct far below. 0 if Alignment::approximate, and if not said.
  double confidence = 0;
  /// False: the word is omitted in the recording, or there is too little room for it between its
  /// neighbours.
  bool said = true;
  bool known = true;  ///< false: unknown pronunciation; it gets the recognised phones
};

/// Speech that is missing in the transcript.
struct Insertion {
  double start = 0;                 ///< seconds
  double end = 0;                   ///< seconds
  std::vector<std::string> phones;  ///< recognised ARPAbet phones, often individually wrong
  std::size_t before = 0;           ///< index of the following word in Alignment::words
};

/// Result of align().
struct Alignment {
  /// Covers the audio exactly; labels are ARPAbet, words as in the transcript. Speech that is
  /// missing in the transcript has the recognised phones, without a word.
  dam::Script script;
  /// Of each phone of `script`, like AlignedWord::confidence, but from few frames and thus less
  /// reliable.
  std::vector<double> confidences;
  /// True if the recogniser found no path: the phones are then spread over the loud part of
  /// the recording in proportion to their usual durations.
  bool approximate = false;
  std::vector<AlignedWord> words;     ///< all of the transcript, in order
  std::vector<Insertion> inserted;    ///< in order
  double confidence = 0;              ///< of the whole recording, as AlignedWord::confidence
  std::vector<std::string> warnings;  ///< sentences for the user; may be empty
};

/// The sample rate required by align().
inline constexpr int kAlignRate = 16000;
/// Maximum length of a recording.
inline constexpr double kMaxAlignSeconds = 4 * 3600.0;
/// Words with a lower confidence are named in the warnings.
inline constexpr double kDoubtful = 0.05;
/// Maximum length of a transcript, bytes.
inline constexpr std::size_t kMostTranscript = 1000000;

/// Aligns a recording, including pauses between words; one that is moved here is not copied. Steady
/// noise is removed first, depending on its level (tools/speech/voice/engines.md, section 1). Words
/// below kDoubtful are named in the warnings. Recordings of more than a minute are aligned in
/// pieces of up to 40 s that end in pauses.
///
/// Errors: invalid_argument (audio that is not 16000 Hz - resample it first -, a transcript without
/// words), truncated (less than 0.1 s of audio), out_of_range (more than kMaxAlignSeconds or
/// kMostTranscript, or too short for so many phones), not_found (model or dictionary; a word
/// without pronunciation in a build without espeak-ng), unsupported (built without pocketsphinx),
/// out_of_range also for a transcript that is rejected (least_confidence), plus those of
/// pronounce().
Result<Alignment> align(media::Pcm audio, std::string_view transcript,
                        const AlignOptions& options = {});

}  // namespace animeme::voice
