// `animeme evaluate --speakers`: training for strangers, on warped copies of the sample corpus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "dam/corpus/corpus.h"
#include "dam/model/builtin.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/adapt.h"
#include "dam/training/train.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"
#include "tools/formats/inspect/warped_speakers.h"

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

/// Mean gap between the inner lips in the middle of a phone.
double gap_in(const dam::Signal& signal, const dam::Script& script, std::string_view label,
              double& count) {
  double sum = 0;
  for (const dam::Phone& phone : script.phones) {
    if (phone.label != label) continue;
    const auto frame =
        std::size_t(std::lround((phone.start + phone.end) / 2 * signal.rate.frames_per_second()));
    sum += dam::inner_gap(signal, std::min(frame, signal.frames() - 1),
                          *dam::inner_lip_channels(signal.names));
    count += 1;
  }
  return sum;
}

// Somebody who opens IY and S wider than AA is left as she is, unless a rule is asked for.
TEST(EvaluateSpeakers, WideVowelsStayWide) {
  const auto recorded = dam::read_corpus(corpus());
  ASSERT_TRUE(recorded);
  inspect::SpeakerHabits habits = inspect::warped_habits(3)[2];
  ASSERT_TRUE(habits.wide_iy);
  habits.noise = 0.1;
  const auto hers = inspect::warp(recorded->utterances, habits);
  ASSERT_TRUE(hers);
  const auto own = dam::train(*hers), adapted = dam::adapt(*dam::builtin_model(), *hers);
  ASSERT_TRUE(own && adapted);
  for (const dam::Model* model : {&*own, &*adapted}) {
    EXPECT_EQ(model->articulation, 0);
    for (const char* label : {"IY", "S"}) {
      double was = 0, is = 0, count = 0;
      for (const dam::Utterance& u : *hers) {
        dam::SynthesisOptions options;
        options.rate = u.signal.rate;
        options.frames = u.signal.frames();
        options.articulation = std::nullopt;
        const auto made = dam::synthesise(*model, u.script, options);
        ASSERT_TRUE(made);
        was += gap_in(u.signal, u.script, label, count);
        is += gap_in(*made, u.script, label, count);
      }
      EXPECT_GT(is, 0.8 * was) << label;
      EXPECT_LT(is, 1.2 * was) << label;
      EXPECT_GT(was / count, 150) << label;
    }
  }
}

TEST(EvaluateSpeakers, RulesHaveAPrice) {
  const json report =
      test::json_of({"evaluate", "builtin", corpus(), "--split", "test", "--rules"});
  ASSERT_EQ(report["rules"].size(), 3u);
  EXPECT_EQ(report["rules"]["articulation"]["gap_nrmse"], 0) << "the lips are left alone";
  EXPECT_NE(report["rules"]["articulation"]["jaw_nrmse"], 0);
  EXPECT_GT(report["rules"]["sharpness"]["nrmse"], 0);
  const auto text = animeme({"evaluate", "builtin", corpus(), "--split", "test", "--rules"});
  EXPECT_THAT(text.out, HasSubstr("what a rule adds"));
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
  EXPECT_THAT(wrong.err, HasSubstr("'x' is not a number of sentences"));
  EXPECT_EQ(animeme({"evaluate", "builtin", corpus(), "--sentences", "4"}).exit_code, 2);
}

}  // namespace evaluate_speakers_test
}  // namespace animeme
