/// @file
/// Forced alignment: when is each sound of a known text spoken in a recording.
///
/// The recogniser is pocketsphinx with its US English model (Debian packages libpocketsphinx-dev
/// to build, pocketsphinx-en-us to run; BSD-style licences), an optional part of the build
/// (ANIMEME_WITH_ALIGNER). English words are looked up in its dictionary; words that are not there
/// and all words of other languages get their phones from espeak-ng (see voice.h), and the English
/// model then aligns them: less exact, but lips forgive more than ears.
/// Source: tools/voice/engines.md, section 1.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/media/pcm.h"

namespace animeme::voice {

/// Language and data of the recogniser.
struct AlignOptions {
  std::string language = "en";  ///< of the transcript, as in VoiceOptions::language
  /// Folder of the acoustic model (with mdef, means ...).
  std::string model_path = "/usr/share/pocketsphinx/model/en-us/en-us";
  /// Pronunciations: "word PH PH ..." a line, further ones as "word(2) ...". Not read when the
  /// language is not English.
  std::string dictionary_path = "/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict";
};

/// What align() found.
struct Alignment {
  /// Covers the audio exactly; labels are ARPAbet, words as the transcript spells them.
  dam::Script script;
  /// True if the recogniser found no path: the phones are then spread over the loud part of
  /// the recording in proportion to their usual durations.
  bool approximate = false;
  std::vector<std::string> warnings;  ///< sentences for people; empty if all went well
};

/// The rate that align() wants.
inline constexpr int kAlignRate = 16000;
/// Longer recordings have to be parted.
inline constexpr double kMaxAlignSeconds = 4 * 3600.0;
/// Bytes of the longest transcript.
inline constexpr std::size_t kMostTranscript = 1000000;

/// Aligns. Pauses between words are found; a text that is not what was said is not noticed.
/// Recordings of more than a minute are aligned in pieces of up to 40 s that end in pauses.
///
/// Errors: invalid_argument (audio that is not 16000 Hz - resample it first -, a transcript
/// without words), truncated (less than 0.1 s of audio), out_of_range (more than
/// kMaxAlignSeconds or kMostTranscript, or too short for so many phones), not_found (model or
/// dictionary; a word without pronunciation where espeak-ng is not built in), unsupported (built
/// without pocketsphinx), plus those of pronounce().
Result<Alignment> align(const media::Pcm& audio, std::string_view transcript,
                        const AlignOptions& options = {});

}  // namespace animeme::voice
