// `animeme evaluate --speakers`: training for strangers, on warped copies of the sample corpus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme {
namespace evaluate_speakers_test {

using nlohmann::json;
using test::animeme;
using testing::HasSubstr;

std::string corpus() { return (test::data_dir() / "grid_s1_sample").string(); }

TEST(EvaluateSpeakers, AdaptingIsNoWorseThanItsIngredients) {
  const json report = test::json_of({"evaluate", "builtin", corpus(), "--speakers", corpus(),
                                     "--sentences", "6", "--copies", "4", "--sharpness", "0"});
  ASSERT_EQ(report["rows"].size(), 4u);
  const json &still = report["rows"][0], &base = report["rows"][1], &own = report["rows"][2],
             &adapted = report["rows"][3];
  EXPECT_EQ(adapted["system"], "adapted");
  const auto mean = [](const json& row, const char* what) -> double {
    return row["mean"][what]["mean"];
  };
  EXPECT_GT(mean(adapted, "gap_correlation"), mean(own, "gap_correlation") - 0.01);
  EXPECT_GT(mean(adapted, "gap_correlation"), mean(base, "gap_correlation") - 0.01);
  EXPECT_LT(mean(adapted, "nrmse"), mean(own, "nrmse") + 0.01);
  EXPECT_LT(mean(adapted, "nrmse"), mean(still, "nrmse"));
  EXPECT_LT(mean(adapted, "nrmse"), mean(base, "nrmse")) << "it takes after the person";
  for (const auto& [name, score] : adapted["speakers"].items()) {
    const double recorded = score["median_gap_recorded"], made = score["median_gap_made"];
    EXPECT_NEAR(made, recorded, 0.4 * recorded + 60) << name << ": the mouth is not shut";
  }
  EXPECT_EQ(report["others"]["recordings"].size(), 24u);
  EXPECT_EQ(report, test::json_of({"evaluate", "builtin", corpus(), "--speakers", corpus(),
                                   "--sentences", "6", "--copies", "4", "--sharpness", "0"}))
      << "the same again";
}

TEST(EvaluateSpeakers, TextAndErrors) {
  const auto text = animeme({"evaluate", "builtin", "--speakers", corpus(), "--split", "train",
                             "--sentences", "4", "--copies", "1", "--base-sentences", "8"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("1 warped speakers"));
  EXPECT_THAT(text.out, HasSubstr("over own"));
  const auto few = animeme({"evaluate", "builtin", "--speakers", corpus(), "--sentences", "200"});
  EXPECT_EQ(few.exit_code, 3);
  EXPECT_THAT(few.err, HasSubstr("at least 204 sentences, these are 24"));
  const auto wrong = animeme({"evaluate", "builtin", "--speakers", corpus(), "--sentences", "4,x"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("not 'x'"));
  EXPECT_EQ(animeme({"evaluate", "builtin", corpus(), "--sentences", "4"}).exit_code, 2);
}

}  // namespace evaluate_speakers_test
}  // namespace animeme
