// Which phones the hypotheses agree on: lips close where enough of them close the lips.
#include <gtest/gtest.h>

#include <array>

#include "tools/speech/voice/hearing.h"

namespace animeme::voice {
namespace agreed_path_test {

HearingModel model_of(const std::vector<std::string>& labels) {
  HearingModel model;
  for (const std::string& label : labels) {
    model.labels.push_back(label);
    model.classes.push_back(dam::find_phone(label)->phone_class);
  }
  return model;
}

// AE, then `frames` with a share for each of P, M, N and S, then AE; as labels.
std::vector<std::string> agreed(std::size_t frames, const std::array<float, 4>& shares,
                                float least = kLeastClosure) {
  const HearingModel model = model_of({"AE", "P", "M", "N", "S"});
  constexpr std::size_t kVowel = 10;
  Votes votes(2 * kVowel + frames, {1, 0, 0, 0, 0});
  for (std::size_t i = kVowel; i < kVowel + frames; ++i) {
    votes[i] = {0, shares[0], shares[1], shares[2], shares[3]};
  }
  std::vector<std::string> labels;
  for (const std::uint8_t phone : agreed_path(model, votes, least)) {
    if (labels.empty() || labels.back() != model.labels[phone]) {
      labels.push_back(model.labels[phone]);
    }
  }
  return labels;
}

using Labels = std::vector<std::string>;

TEST(AgreedPath, ClosesTheLipsWhereEnoughPathsDo) {
  for (const std::size_t frames : {4, 7, 15}) {
    EXPECT_EQ(agreed(frames, {0.9f, 0, 0.1f, 0}), (Labels{"AE", "P", "AE"}));
    EXPECT_EQ(agreed(frames, {0.45f, 0, 0.3f, 0.25f}), (Labels{"AE", "P", "AE"}));
    EXPECT_EQ(agreed(frames, {0.25f, 0.2f, 0.3f, 0.25f}), (Labels{"AE", "P", "AE"}))
        << "all of them close the lips";
  }
}

TEST(AgreedPath, AFewPathsDoNotCloseTheLips) {
  for (const std::size_t frames : {4, 7, 15}) {
    EXPECT_EQ(agreed(frames, {0.36f, 0, 0.34f, 0.3f}), (Labels{"AE", "N", "AE"}));
    EXPECT_EQ(agreed(frames, {0, 0.38f, 0.3f, 0.32f}), (Labels{"AE", "S", "AE"}));
    EXPECT_EQ(agreed(frames, {0, 0.38f, 0.3f, 0.32f}, 0), (Labels{"AE", "M", "AE"})) << "live";
    EXPECT_EQ(agreed(frames, {0.2f, 0.15f, 0.33f, 0.32f}), (Labels{"AE", "N", "AE"}));
  }
}

TEST(AgreedPath, OneDoubtfulClosureLeavesTheOthers) {
  const HearingModel model = model_of({"AE", "P", "M", "N", "S"});
  Votes votes;
  const auto add = [&](std::size_t frames, std::vector<float> shares) {
    votes.insert(votes.end(), frames, std::move(shares));
  };
  add(8, {1, 0, 0, 0, 0});
  add(6, {0, 0.7f, 0, 0.3f, 0});
  add(8, {1, 0, 0, 0, 0});
  add(6, {0, 0, 0.35f, 0.33f, 0.32f});
  add(8, {1, 0, 0, 0, 0});
  const Path path = agreed_path(model, votes, kLeastClosure);
  ASSERT_EQ(path.size(), votes.size());
  EXPECT_EQ(model.labels[path[10]], "P");
  EXPECT_EQ(model.labels[path[25]], "N");
  EXPECT_TRUE(agreed_path(model, {}, kLeastClosure).empty());
}

}  // namespace agreed_path_test
}  // namespace animeme::voice
