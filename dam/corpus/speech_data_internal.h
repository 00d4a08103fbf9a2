// Training sentences as numbers, the same for all kinds of models: targets in units of the training
// standard deviation, measured from rest, and the phones that were spoken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace animeme::dam {

struct FitOccurrence {
  double start = 0;  ///< seconds from the start of its sentence
  double duration = 0;
  std::int32_t phone = 0;  ///< index of Model::phones
  std::int32_t left = 0;   ///< phones beside it, kRestContext: the resting mouth
  std::int32_t right = 0;
  std::uint32_t mode = 0;  ///< numbered over all phones; for kinds that have modes

  double end() const { return start + duration; }
};

struct FitSentence {
  std::size_t first_frame = 0, frames = 0;
  std::size_t first_occurrence = 0, occurrences = 0;
};

struct SpeechData {
  std::size_t controls = 0;
  double rate = 25;                 ///< frames per second
  std::vector<double> target;       ///< frames x controls
  std::vector<std::uint8_t> use;    ///< per frame: 0 is left out
  std::vector<std::uint32_t> word;  ///< per frame: number of the word that is spoken, 0: none known
  std::vector<FitSentence> sentences;
  std::vector<FitOccurrence> occurrences;
};

}  // namespace animeme::dam
