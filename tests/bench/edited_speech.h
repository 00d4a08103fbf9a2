// Recordings of two sentences that differ from their text by one word, and what alignment makes of
// them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/align_material.h"
#include "tools/speech/voice/align.h"

namespace animeme::bench {

enum class Edit {
  none,
  text_more,   // the text has a word that is not said
  cut_out,     // a word is cut out of the sound
  text_less,   // the text lacks a word that is said
  spliced_in,  // a word of another sentence is put into the sound
};

inline constexpr Edit kEdits[] = {Edit::none, Edit::text_more, Edit::cut_out, Edit::text_less,
                                  Edit::spliced_in};
std::string_view name_of(Edit edit);

struct EditedSpeech {
  Edit edit = Edit::none;
  std::vector<std::string> words;  // of the text
  std::vector<float> sound;        // 16 kHz
  dam::Script labels;              // of the sound
  std::size_t missing = 0;         // number of the word that is not said, if there is one
  double start = 0, end = 0;       // of the speech that the text lacks, or the cut
  std::string text() const;
};

// Two sentences behind each other, changed. The same for the same seed.
EditedSpeech edit_speech(const Sentence& one, const Sentence& two, const Sentence& other, Edit edit,
                         std::uint64_t seed);

// What was noticed, over many recordings.
struct EditScore {
  std::size_t recordings = 0, refused = 0, found = 0;
  std::size_t words = 0, false_out = 0;  // words that are said; of these taken for left out
  std::size_t false_in = 0;              // stretches taken for speech that the text lacks
  Score times;                           // of all other phones
  void add(const EditedSpeech& speech, const Result<voice::Alignment>& found);
};

}  // namespace animeme::bench
