// Sentence pairs with known answers, for the tests of score().
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"

namespace animeme::dam::sentence_pairs {

inline constexpr int kFrames = 100;  // 4 s at 25 Hz

/// "SIL 0..0.2, then the phones, 0.1 s each, then SIL to the end".
inline Script script_of(const std::vector<std::string>& labels) {
  Script script;
  script.phones.push_back({0, 0.2, "SIL", ""});
  double at = 0.2;
  for (const std::string& label : labels) {
    script.phones.push_back({at, at + 0.1, label, label == "SIL" ? "" : "word"});
    at += 0.1;
  }
  if (at < 4) script.phones.push_back({at, 4, "SIL", ""});
  return script;
}

/// A pair whose both sides are given by functions of channel and frame; channels are named by FAP.
using Value = std::function<double(int fap, int frame)>;
inline SentencePair pair_of(const std::vector<int>& faps, const Script& script,
                            const Value& recorded, const Value& made, int frames = kFrames) {
  SentencePair pair;
  pair.recorded.id = "one";
  pair.recorded.script = script;
  for (Signal* signal : {&pair.recorded.signal, &pair.synthesised}) {
    const Value& value = signal == &pair.synthesised ? made : recorded;
    for (const int fap : faps) signal->names.push_back("fap" + std::to_string(fap));
    for (int i = 0; i < frames; ++i)
      for (const int fap : faps) signal->values.push_back(value(fap, i));
  }
  return pair;
}

/// Speech all through: vowels only, so that no lip has to close.
inline Script vowels() { return script_of(std::vector<std::string>(36, "AE")); }

/// The same, but frames 30 to 32 are B (1.2 s to 1.3 s).
inline Script with_bilabial() {
  std::vector<std::string> labels(36, "AE");
  labels[10] = "B";
  return script_of(labels);
}

/// Some smooth motion without a short period.
inline double wave(double frame) {
  return 100 * std::sin(frame * 0.31) + 60 * std::sin(frame * 0.17 + 1) +
         40 * std::sin(frame * 0.53 + 2);
}

/// A control called fapN, with deviation 100 and mean 0.
inline std::vector<Control> scale_of(const std::vector<int>& faps) {
  std::vector<Control> scale;
  for (const int fap : faps) scale.push_back({"fap" + std::to_string(fap), 0, 0, 100});
  return scale;
}

inline Evaluation score_with(const SentencePair& pair, const ScoreOptions& options) {
  auto result = score({&pair, 1}, options);
  EXPECT_TRUE(result) << result.error().describe();
  return result ? *result : Evaluation();
}

inline Evaluation score_one(const SentencePair& pair, const std::vector<int>& faps) {
  return score_with(pair, {.scale = scale_of(faps)});
}

}  // namespace animeme::dam::sentence_pairs
