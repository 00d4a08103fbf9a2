// Voices to listen to, with what was said in them: sentences of a corpus with its faces, or other
// recordings, whose truth is the alignment of their text and the face that it makes.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::bench {

constexpr double kNear = 0.060;  // seconds: a closure counts for a phone so far away

/// The value, or the end of the program with the error.
template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().describe().c_str());
  std::exit(3);
}

struct Voice {
  dam::Utterance sentence;  // text, phones, and the motion to compare with
  media::Pcm sound;         // 16 kHz
};

struct Voices {
  dam::Model model;
  std::vector<Voice> rows;
};

// Which rows.
struct Choice {
  std::string rows = "test", column = "split";  // of a corpus
  std::size_t every = 1, from = 0;              // every n-th, beginning with one
  std::string language = "en";                  // of recordings
};

// A corpus. The model learns from rows that are not listened to: those of "train" for "test",
// those without sound else.
Result<Voices> read_corpus_voices(const std::string& folder, const Choice& choice);

// All rows of a corpus that have sound. The built-in model speaks, which has heard none of them.
Result<Voices> read_strangers(const std::string& folder, const Choice& choice);

// Recordings FOLDER/ID.g722 or .wav and a list of lines "ID: text" (Asterisk's), lines of less than
// 60 bytes left out, and those that do not align. The built-in model speaks.
Result<Voices> read_recordings(const std::string& folder, const std::string& list,
                               const Choice& choice);

// The share of words that are wrong, left out or put in, in words: {errors, words}.
struct WordErrors {
  std::size_t errors = 0, words = 0;
};
WordErrors count_word_errors(const std::string& said, const std::vector<std::string>& heard);

}  // namespace animeme::bench
