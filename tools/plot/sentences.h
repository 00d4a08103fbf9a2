/// @file
/// Pictures of evaluations: recorded and made motion of a few sentences.
#pragma once

#include <string>
#include <vector>

#include "dam/evaluation/evaluate.h"
#include "fap/result.h"

namespace animeme::plot {

/// Best, median and worst sentence by NRMSE, one below the other (of two sentences the best and the
/// worst, of one that one): recorded and made curves of jaw (FAP 3), inner gap (-(FAP 4 + FAP 5))
/// and width (FAP 6 + FAP 7), as far as both sides have these FAPs; if there is none of them, of
/// the first three controls. Bars below the gap: when the lips are shut for P, B and M (less than
/// dam::kShutGap), recorded above made. `pairs` is not empty, and `evaluation` is that of these
/// pairs, in their order. Error: out_of_range (a sentence over ten minutes).
Result<std::string> sentences_svg(const std::vector<dam::SentencePair>& pairs,
                                  const dam::Evaluation& evaluation);

}  // namespace animeme::plot
