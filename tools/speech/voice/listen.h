/// @file
/// Speech from sound alone: which phones may have been said, by nobody's word.
///
///     auto heard = animeme::voice::listen(*pcm);
///     for (std::size_t i = 0; i < heard->script.phones.size(); ++i)
///       std::cout << heard->script.phones[i].label << ' ' << heard->confidences[i] << '\n';
///
/// A recogniser of phones is wrong about every second one, and a face that follows its best guess
/// shows that. So there are `readings`, too: what may have been said, each as often as it is
/// probable. The mean of the motions that they give errs least (tools/speech/talking/heard_face.h).
///
/// The sounds are those of the US English model of pocketsphinx (Debian packages
/// libpocketsphinx-dev to build, pocketsphinx-en-us to run); other languages are heard through it,
/// by the sounds that are nearest. Source: tools/speech/voice/engines.md, section 3.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::voice {

/// How listen() hears.
struct ListenOptions {
  /// Of the voice. English has its own pairs of phones; in others ("de") all are as likely.
  std::string language = "en";
  /// Folder of the acoustic model (with mdef, means ...).
  std::string model_path = "/usr/share/pocketsphinx/model/en-us/en-us";
  /// Which phones follow each other: a language model of phones in any format of pocketsphinx.
  std::string phones_path = "/usr/share/pocketsphinx/model/en-us/en-us-phone.lm.bin";
  /// English words are searched for, too, where the two files that follow are there. They are
  /// followed as far as they are believed: the more of them make a sentence and fit, the more.
  bool words = true;
  /// Which words follow each other: a language model in any format of pocketsphinx.
  std::string words_path = "/usr/share/pocketsphinx/model/en-us/en-us.lm.bin";
  /// How they are spoken, see AlignOptions::dictionary_path.
  std::string dictionary_path = "/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict";
  std::size_t readings = 24;  ///< how many are drawn, 1..200
  /// Told the share that is done, 0..1; may be empty.
  std::function<void(double)> progress;
};

/// A word of English that may have been said.
struct HeardWord {
  std::string text;       ///< in small letters
  double start = 0;       ///< seconds
  double end = 0;         ///< seconds
  double confidence = 0;  ///< 0..1
};

/// What listen() heard. All scripts cover the sound exactly, their labels are ARPAbet.
struct Heard {
  dam::Script script;  ///< what most readings agree on; with the words of `words`
  std::vector<double>
      confidences;        ///< of each phone of `script`: the share of readings that agree, 0..1
  double confidence = 0;  ///< their mean over time, silence left out; 0: nothing was heard
  std::vector<HeardWord> words;       ///< English ones that are believable, in order
  std::vector<dam::Script> readings;  ///< each as likely as the others
  std::vector<std::string> warnings;  ///< sentences for people; empty if all went well
};

/// Longer recordings have to be parted.
inline constexpr double kMostListenSeconds = 4 * 3600.0;

/// Listens. Noise that stays is taken out before (denoise.h). Memory: about 10 MB a minute.
/// Silence and steady noise give a script of silence, and a warning.
///
/// Errors: invalid_argument (audio that is not 16000 Hz - resample it first -, readings out of
/// range), truncated (less than 0.1 s of audio), out_of_range (more than kMostListenSeconds),
/// not_found (a model), syntax (a damaged one), unsupported (built without pocketsphinx; a model of
/// another kind).
Result<Heard> listen(const media::Pcm& audio, const ListenOptions& options = {});

}  // namespace animeme::voice
