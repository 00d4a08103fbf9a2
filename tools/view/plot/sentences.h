/// @file
/// Plots for evaluations: recorded and synthesised motion of a few sentences.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"
#include "fap/result.h"

namespace animeme::plot {

/// A representative sentence.
struct ChosenSentence {
  const char* place = "";  ///< "best", "median", "worst"
  std::size_t number = 0;  ///< index of Evaluation::per_utterance
};
/// Best, median and worst sentence by NRMSE; best and worst if there are two, or the only one.
std::vector<ChosenSentence> chosen_sentences(const dam::Evaluation& evaluation);

/// chosen_sentences(), one below the other (of two sentences the best and the worst, of one that
/// one): recorded and synthesised curves of jaw (FAP 3), inner gap (-(FAP 4 + FAP 5)) and width
/// (FAP 6 + FAP 7), as far as both sides have these FAPs; without these, of the first three
/// controls. Bars below the gap show when the lips are closed for P, B and M (less than
/// dam::kClosedGap), recorded above synthesised. `pairs` is not empty, and `evaluation` is that of
/// these pairs, in their order. Error: out_of_range (a sentence over ten minutes).
Result<std::string> sentences_svg(const std::vector<dam::SentencePair>& pairs,
                                  const dam::Evaluation& evaluation);

}  // namespace animeme::plot
