// Sentences of a corpus with their sound, and how far an alignment is from their labels.
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::bench {

inline constexpr double kSpeechRate = 16000;

struct Sentence {
  std::string id, text;
  std::vector<float> sound;  // 16 kHz
  dam::Script labels;
  std::size_t first_sample() const;  // of the speech
  std::size_t last_sample() const;   // behind it
};

// Every `every`-th of those that have sound, from number `first` on.
Result<std::vector<Sentence>> read_sentences(const std::string& corpus, std::size_t every,
                                             std::size_t first);

// The speech of each, without what is before and behind it: what babble is made of.
std::vector<std::vector<float>> voices_of(const std::vector<Sentence>& sentences);

// What alignments are worth, over many sentences.
struct Score {
  std::vector<double> errors;      // ms, found minus label, of the starts of phones in words
  std::size_t phones = 0;          // found
  std::size_t shortest = 0;        // of these as short as can be
  double false_pause_seconds = 0;  // between the first and last word, where the labels have none
  std::size_t sentences = 0, none = 0;

  void add(const dam::Script& labels, const dam::Script& found);
  double median() const;  // of the distances
  double mean() const;
  double ninety() const;  // 90 % are within
  double bias() const;    // the median with its sign
  double shortest_share() const;
};

double percentile(std::vector<double> values, double share);

}  // namespace animeme::bench
