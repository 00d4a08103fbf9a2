/// @file
/// English words in sound, by pocketsphinx and its language model of words. Internal. Source:
/// tools/speech/voice/engines.md, section 3.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/sound_model.h"

namespace animeme::voice {

/// A word that may have been said.
struct FoundWord {
  std::string text;                 ///< as the dictionary writes it
  std::vector<std::string> phones;  ///< how it is spoken; "AA" ... as in SoundModel::phones
  std::size_t first = 0;            ///< its first frame
  std::size_t end = 0;              ///< the frame behind its last one
  double language = 0;              ///< log probability of its place in the sentence
  double belief = 0;                ///< against other words in its place, 0..1
};

/// What a search needs.
struct WordFiles {
  std::string model_path;       ///< folder of the acoustic model
  std::string words_path;       ///< which words follow each other
  std::string dictionary_path;  ///< how they are spoken
};

/// Half a second is taken by opening the first one of a process; one that is closed waits (100 MB)
/// for the next. Not thread safe, but several may be used at once.
class WordSearch {
 public:
  /// Errors: unsupported (built without pocketsphinx), not_found (a file), syntax (one is damaged).
  static Result<std::unique_ptr<WordSearch>> open(const WordFiles& files);
  virtual ~WordSearch() = default;
  /// The words of a piece of sound, in order. Frames without a word are silence or noise. Nothing
  /// if there is no speech.
  virtual std::vector<FoundWord> search(std::span<const Cepstrum> frames, const Cepstrum& mean) = 0;
};

}  // namespace animeme::voice
