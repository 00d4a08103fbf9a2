/// @file
/// Phone recognition: speech from sound alone, without a transcript.
///
///     auto heard = animeme::voice::listen(*pcm);
///     for (std::size_t i = 0; i < heard->script.phones.size(); ++i)
///       std::cout << heard->script.phones[i].label << ' ' << heard->confidences[i] << '\n';
///
/// A phone recogniser gets every second phone wrong, and a face that follows its best hypothesis
/// shows that. So there are also `readings`: hypotheses sampled by their probability. The mean of
/// their motions has the smallest error (tools/speech/talking/voice_driven_face.h).
///
/// The sounds are those of the US English model of pocketsphinx (Debian packages
/// libpocketsphinx-dev to build, pocketsphinx-en-us to run); other languages are recognised with
/// its nearest phones. Source: tools/speech/voice/engines.md, section 3.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::voice {

/// Options for recognition.
struct ListenOptions {
  /// Language of the voice. For English phone pairs are weighted; for others ("de") all are equally
  /// likely.
  std::string language = "en";
  /// Folder of the acoustic model (with mdef, means ...).
  std::string model_path = "/usr/share/pocketsphinx/model/en-us/en-us";
  /// Phone language model in any format of pocketsphinx.
  std::string phones_path = "/usr/share/pocketsphinx/model/en-us/en-us-phone.lm.bin";
  /// Also search for English words if the following two files exist. Words influence the result by
  /// their confidence, which is higher if they fit and form a sentence.
  bool words = true;
  /// Word language model in any format of pocketsphinx.
  std::string words_path = "/usr/share/pocketsphinx/model/en-us/en-us.lm.bin";
  /// Pronunciations, see AlignOptions::dictionary_path.
  std::string dictionary_path = "/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict";
  std::size_t readings = 24;  ///< number of sampled hypotheses, 1..200
  /// Receives the progress, 0..1; may be empty.
  std::function<void(double)> progress;
};

/// A recognised English word.
struct RecognisedWord {
  std::string text;       ///< in lower case
  double start = 0;       ///< seconds
  double end = 0;         ///< seconds
  double confidence = 0;  ///< 0..1
};

/// Result of listen(). All scripts cover the sound exactly; labels are ARPAbet.
struct Recognition {
  dam::Script script;  ///< the consensus of the readings, with the words of `words`
  std::vector<double>
      confidences;  ///< of each phone of `script`: how likely the mouth is right, 0..1
  double confidence =
      0;  ///< their mean over time without silence; 0: no speech; below 0.6 warned of
  std::vector<RecognisedWord> words;  ///< credible English words, in order
  std::vector<dam::Script> readings;  ///< equally likely hypotheses
  std::vector<std::string> warnings;  ///< sentences for the user; may be empty
};

/// Maximum length of a recording.
inline constexpr double kMostListenSeconds = 4 * 3600.0;

/// Recognises phones, in a child process (guarded.h), as the library ends a process that has no
/// memory. Steady noise is removed first (denoise.h). Memory: about 10 MB a minute.
/// Silence and steady noise give a script of silence, and a warning.
///
/// Errors: invalid_argument (audio that is not 16000 Hz - resample it first -, readings out of
/// range), truncated (less than 0.1 s of audio), out_of_range (more than kMostListenSeconds),
/// not_found (a model), syntax (a damaged one), unsupported (built without pocketsphinx; a model of
/// another kind), those of run_guarded().
Result<Recognition> listen(const media::Pcm& audio, const ListenOptions& options = {});

}  // namespace animeme::voice
