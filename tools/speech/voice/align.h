/// @file
/// Forced alignment: when is each sound of a known text spoken in a recording.
///
/// The recogniser is pocketsphinx with its US English model (Debian packages libpocketsphinx-dev
/// to build, pocketsphinx-en-us to run; BSD-style licences), an optional part of the build
/// (ANIMEME_WITH_ALIGNER). English words are looked up in its dictionary; words that are not there
/// and all words of other languages get their phones from espeak-ng (see voice.h), and the English
/// model then aligns them: less exact, but lips forgive more than ears.
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
  /// Pronunciations: "word PH PH ..." a line, further ones as "word(2) ...". Not read when the
  /// language is not English.
  std::string dictionary_path = "/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict";
  /// Alignments that are less sure on the whole (Alignment::confidence), 0..1, are refused: noise,
  /// silence, the text of another recording. 0: nothing is.
  double least_confidence = 0.5;
};

/// A word where it was found.
struct AlignedWord {
  std::string text;  ///< as the transcript spells it
  double start = 0;  ///< seconds
  double end = 0;    ///< seconds; `start` if it is not said
  /// How well the sound fits, 0..1: its frames are compared with the phones that fit best when
  /// nobody says which. At 0.5 right and wrong texts are as likely, of whole recordings; a single
  /// short word may be right far below. 0 where Alignment::approximate, and if it is not said.
  double confidence = 0;
  /// False: the recording goes from the word before to the one behind, or there is so little room
  /// between them that it is there for the text only.
  bool said = true;
  bool known = true;  ///< false: nobody knows how it is pronounced; it has what is heard there
};

/// Speech that the transcript does not have.
struct PutIn {
  double start = 0;                 ///< seconds
  double end = 0;                   ///< seconds
  std::vector<std::string> phones;  ///< what it sounds like, ARPAbet; often wrong one by one
  std::size_t before = 0;           ///< number of the word that follows, of Alignment::words
};

/// What align() found.
struct Alignment {
  /// Covers the audio exactly; labels are ARPAbet, words as the transcript spells them. Speech that
  /// the transcript does not have has the phones that are heard, without a word.
  dam::Script script;
  /// Of each phone of `script`, as AlignedWord::confidence, of its own frames: few are less sure.
  std::vector<double> confidences;
  /// True if the recogniser found no path: the phones are then spread over the loud part of
  /// the recording in proportion to their usual durations.
  bool approximate = false;
  std::vector<AlignedWord> words;     ///< all of the transcript, in order
  std::vector<PutIn> put_in;          ///< in order
  double confidence = 0;              ///< of the whole recording, as AlignedWord::confidence
  std::vector<std::string> warnings;  ///< sentences for people; empty if all went well
};

/// The rate that align() wants.
inline constexpr int kAlignRate = 16000;
/// Longer recordings have to be parted.
inline constexpr double kMaxAlignSeconds = 4 * 3600.0;
/// Words that are less sure are named in the warnings.
inline constexpr double kDoubtful = 0.05;
/// Bytes of the longest transcript.
inline constexpr std::size_t kMostTranscript = 1000000;

/// Aligns. Pauses between words are found. Noise that stays is taken out before, as much as there
/// is (tools/speech/voice/engines.md, section 1). Words below kDoubtful are named in the warnings.
/// Recordings of more than a minute are aligned in pieces of up to 40 s that end in pauses.
///
/// Errors: invalid_argument (audio that is not 16000 Hz - resample it first -, a transcript
/// without words), truncated (less than 0.1 s of audio), out_of_range (more than
/// kMaxAlignSeconds or kMostTranscript, or too short for so many phones), not_found (model or
/// dictionary; a word without pronunciation where espeak-ng is not built in), unsupported (built
/// without pocketsphinx), out_of_range also for an alignment below least_confidence, plus those of
/// pronounce().
Result<Alignment> align(const media::Pcm& audio, std::string_view transcript,
                        const AlignOptions& options = {});

}  // namespace animeme::voice
