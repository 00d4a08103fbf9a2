// Sums of made-up sentences, for the tests of training in parts.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dam/training/accumulate.h"
#include "tests/dam/dam_support.h"

namespace animeme::test {

inline std::vector<dam::Utterance> planted(std::size_t count, std::uint32_t seed = 5,
                                           std::vector<std::string> labels = {"SIL", "AA", "B",
                                                                              "IY"}) {
  Uniform random(seed);
  const auto truth = plant(random, std::move(labels), 2, 2);
  return planted_sentences(random, truth, count);
}

inline dam::TrainingSums sums_of(std::span<const dam::Utterance> sentences,
                                 const dam::Model* base = nullptr,
                                 const dam::TrainOptions& options = {}) {
  auto sums = dam::TrainingSums::start(options, base);
  EXPECT_TRUE(sums);
  for (const dam::Utterance& u : sentences) {
    const auto added = sums->add(u);
    EXPECT_TRUE(added && *added) << u.id;
  }
  return std::move(*sums);
}

}  // namespace animeme::test
