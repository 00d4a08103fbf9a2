/// @file
/// The search of the recogniser, in a child process: the library ends its process where memory is
/// short. Internal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/pronunciation.h"
#include "tools/speech/voice/speech_part.h"

namespace animeme::voice {

/// A phone that the search has placed. Segments follow each other without gaps.
struct Segment {
  double start = 0;      ///< seconds; the bias of the analysis window is already taken off
  std::string label;     ///< ARPAbet or SIL
  std::size_t word = 0;  ///< index into the words; kNoWord for silence
  /// How well the sound fits, a frame: 0 is as well as the phones that fit best when nobody says
  /// which; logarithm of the likelihood.
  double score = 0;
  std::size_t frames = 1;  ///< of 10 ms
  bool foreign = false;    ///< heard, not of the text
};

inline constexpr std::size_t kNoWord = ~std::size_t(0);  ///< no word: silence

/// Is there a recogniser and the model it needs? Errors: unsupported, not_found.
Result<void> check_recogniser(const AlignOptions& options);

/// What is recognised.
struct Recognised {
  std::vector<Segment> segments;  ///< empty if no path was found
  double explained = 0;           ///< Placement::explained
};

/// Places the words in speech; times are those of the recording. Errors as check_recogniser(), and
/// those of run_guarded().
Result<Recognised> recognise(const SpeechPart& part, const std::vector<SpokenWord>& words,
                             const AlignOptions& options);

/// What texts that nobody said explain of the same speech (Placement::explained), each made of the
/// words: how well a wrong text of their kind fits. Takes as long as kWrongTexts alignments. Errors
/// as check_recogniser().
Result<std::vector<double>> explained_by_wrong_texts(const SpeechPart& part,
                                                     const std::vector<SpokenWord>& words,
                                                     const AlignOptions& options);

}  // namespace animeme::voice
