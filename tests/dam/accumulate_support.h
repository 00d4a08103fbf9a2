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
