// Training in parts: the same model as in one go, every sentence once.
#include "dam/training/accumulate.h"
#include "dam/training/training_sums_internal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dam/corpus/corpus.h"
#include "tests/dam/accumulate_support.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace accumulate_test {

using test::planted;
using test::sums_of;
using testing::Contains;
using testing::HasSubstr;

const std::vector<Utterance>& sample() {
  static const std::vector<Utterance> sentences = [] {
    const auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
    return corpus ? corpus->utterances : std::vector<Utterance>{};
  }();
  return sentences;
}

TrainingSums copy_of(const TrainingSums& sums) {
  return std::move(*read_training_sums(write_training_sums(sums)));
}

/// Both models, numbers by numbers.
void expect_near(const Model& a, const Model& b, double tolerance) {
  ASSERT_EQ(a.controls.size(), b.controls.size());
  ASSERT_EQ(a.phones.size(), b.phones.size());
  const auto near = [&](double x, double y, double scale) {
    EXPECT_NEAR(x, y, tolerance * (scale + std::abs(x)));
  };
  for (std::size_t c = 0; c < a.controls.size(); ++c) {
    near(a.controls[c].mean, b.controls[c].mean, a.controls[c].sd);
    near(a.controls[c].sd, b.controls[c].sd, 0);
    near(a.controls[c].rest, b.controls[c].rest, a.controls[c].sd);
  }
  for (std::size_t p = 0; p < a.phones.size(); ++p) {
    EXPECT_EQ(a.phones[p].label, b.phones[p].label);
    EXPECT_EQ(a.phones[p].examples, b.phones[p].examples);
    EXPECT_EQ(a.phones[p].longest, b.phones[p].longest);
  }
  const auto& x = std::get<RefinedParameters>(a.parameters);
  const auto& y = std::get<RefinedParameters>(b.parameters);
  EXPECT_EQ(x.dominance, y.dominance);
  ASSERT_EQ(x.tables.size(), y.tables.size());
  for (std::size_t t = 0; t < x.tables.size(); ++t) {
    ASSERT_EQ(x.tables[t].keys, y.tables[t].keys);
    for (std::size_t i = 0; i < x.tables[t].values.size(); ++i)
      near(double(x.tables[t].values[i]), double(y.tables[t].values[i]), 1);
  }
}

// ---- the same model ----

TEST(Accumulate, GivesTheModelOfTrainForItsDominance) {
  TrainSummary whole_summary, summary;
  TrainOptions options;
  options.refined.terms = kSummedTerms;
  options.refined.rare_words = 0;  // parts count all words alike
  options.refined.ridge = 1;       // other sentences are held out
  const auto whole = train(sample(), options, &whole_summary);
  ASSERT_TRUE(whole);
  const auto model = train_from_sums(sums_of(sample(), &*whole), options, &summary);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_TRUE(validate(*model));
  expect_near(*whole, *model, 1e-5);  // tables are of single precision
  for (std::size_t p = 0; p < whole->phones.size(); ++p)
    EXPECT_EQ(whole->phones[p], model->phones[p]);
  EXPECT_EQ(whole_summary.frames, summary.frames);
  EXPECT_EQ(whole_summary.occurrences, summary.occurrences);
  EXPECT_NEAR(whole->closure_gap, model->closure_gap, 0.25);
  EXPECT_NEAR(*whole->lip_tooth_raise, *model->lip_tooth_raise, 0.25);
  ASSERT_TRUE(whole->closure_duration && model->closure_duration);
  EXPECT_NEAR(whole->closure_duration->base, model->closure_duration->base, 1e-9);
  EXPECT_NEAR(whole->closure_duration->slope, model->closure_duration->slope, 1e-9);
}

TEST(Accumulate, WithoutBaseItStartsFromTheStartValues) {
  const auto model = train_from_sums(sums_of(planted(12)));
  ASSERT_TRUE(model);
  for (const PhoneDominance& d : std::get<RefinedParameters>(model->parameters).dominance)
    EXPECT_EQ(d, PhoneDominance{});
  for (const PhoneModel& phone : model->phones) EXPECT_EQ(phone.duration, 0.08);
}

TEST(Accumulate, PartsAddUpToTheWhole) {
  const std::span<const Utterance> all = sample();
  const auto base = train(planted(10));
  ASSERT_TRUE(base);
  TrainOptions options;
  options.refined.ridge = 1;  // the search for it solves three times
  const auto whole = train_from_sums(sums_of(all, &*base), options);
  auto parts = sums_of(all.first(5), &*base);  // which lack phones that the others have
  ASSERT_TRUE(parts.merge(sums_of(all.subspan(5, 12), &*base)));
  ASSERT_TRUE(parts.merge(sums_of(all.subspan(17), &*base)));
  EXPECT_EQ(parts.sentences(), all.size());
  const auto merged = train_from_sums(std::move(parts), options);
  ASSERT_TRUE(whole && merged);
  expect_near(*whole, *merged, 1e-6);
  EXPECT_EQ(whole->closure_gap, merged->closure_gap);
  EXPECT_EQ(whole->lip_tooth_raise, merged->lip_tooth_raise);
}

TEST(Accumulate, ACorpusCutInAnyWayGivesTheSameBytes) {
  const std::span<const Utterance> all = std::span(sample()).first(12);
  TrainOptions options;
  options.refined.ridge = 1;  // the search for it solves three times
  const auto whole = write_training_sums(sums_of(all));
  const auto model = train_from_sums(sums_of(all), options);
  ASSERT_TRUE(model);
  test::Uniform random(12);
  for (std::size_t shards = 1; shards <= 7; ++shards) {
    SCOPED_TRACE(shards);
    std::vector<Utterance> shuffled(all.begin(), all.end());
    for (std::size_t i = shuffled.size(); i > 1; --i)
      std::swap(shuffled[i - 1], shuffled[random.below(i)]);
    std::vector<std::vector<Utterance>> parts(shards);  // of unequal size, some without a sentence
    for (Utterance& u : shuffled) parts[random.below(1 + random.below(shards))].push_back(u);
    TrainingSums sums = sums_of({});
    for (const auto& part : parts) ASSERT_TRUE(sums.merge(copy_of(sums_of(part))));
    EXPECT_TRUE(write_training_sums(sums) == whole);
    if (shards != 7) continue;  // solving takes long
    const auto again = train_from_sums(std::move(sums), options);
    ASSERT_TRUE(again);
    EXPECT_TRUE(write_model(*again) == write_model(*model));
  }
}

TEST(Accumulate, ValuesTooLargeForExactSumsAreRefused) {
  auto sentences = planted(3);
  auto sums = sums_of(std::span(sentences).first(1));
  const auto before = write_training_sums(sums);
  for (double& v : sentences[1].signal.values) v *= 1e8;
  const auto added = sums.add(sentences[1]);
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message, testing::AllOf(HasSubstr("'s101'"), HasSubstr("too large")));
  EXPECT_TRUE(write_training_sums(sums) == before);
  for (double& v : sentences[2].signal.values) v *= 1e6;
  EXPECT_TRUE(sums.add(sentences[2]));
}

TEST(Accumulate, PartsMayHaveOtherPhones) {
  auto a = planted(9, 5), b = planted(9, 6, {"SIL", "UW", "IY", "S"});
  for (Utterance& u : b) u.id = "b" + u.id;
  auto parts = sums_of(a);
  ASSERT_TRUE(parts.merge(sums_of(b)));
  a.insert(a.end(), b.begin(), b.end());
  const auto whole = train_from_sums(sums_of(a)), merged = train_from_sums(std::move(parts));
  ASSERT_TRUE(whole && merged);
  EXPECT_EQ(merged->phones.size(), 6u);
  expect_near(*whole, *merged, 1e-6);
}

TEST(Accumulate, ChoosesTheRidgeBySentencesHeldOut) {
  auto sentences = planted(40);
  TrainSummary clear, noisy;
  ASSERT_TRUE(train_from_sums(sums_of(sentences), {}, &clear));
  test::Uniform random(8);
  for (Utterance& u : sentences)
    for (double& v : u.signal.values) v = random(-1, 1);
  ASSERT_TRUE(train_from_sums(sums_of(sentences), {}, &noisy));
  EXPECT_GT(noisy.ridge, clear.ridge);
  EXPECT_TRUE(clear.held_out);
  EXPECT_GT(clear.controls[0].explained, 0.8);
  EXPECT_LT(noisy.controls[0].explained, kNoise);
  EXPECT_THAT(noisy.warnings, Contains(HasSubstr("may be noise")));
}

TEST(Accumulate, ConstantControlsAndSilentSentences) {
  auto sentences = planted(6);
  for (Utterance& u : sentences)
    for (std::size_t i = 0; i < u.signal.frames(); ++i) u.signal.at(i, 1) = 0.1;
  sentences[2].script.phones = {{0, 1.0, "SIL", ""}};
  TrainSummary summary;
  const auto model = train_from_sums(sums_of(sentences), {}, &summary);
  ASSERT_TRUE(model) << model.error().describe();
  EXPECT_EQ(model->controls[1].sd, 0);
  EXPECT_NEAR(model->controls[1].rest, 0.1, 1e-12);
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("'c1' never moves")));
  const auto silent = train_from_sums(sums_of(std::span(sentences).subspan(2, 1)));
  ASSERT_FALSE(silent);
  EXPECT_THAT(silent.error().message, HasSubstr("silence"));
  EXPECT_FALSE(train_from_sums(sums_of({})));
}

// ---- every sentence once ----

TEST(Accumulate, GoesOnAfterAnInterruptionAsIfThereWereNone) {
  const std::span<const Utterance> all = sample();
  const auto uninterrupted = write_training_sums(sums_of(all));
  auto resumed = copy_of(sums_of(all.first(7)));
  std::size_t added = 0;
  for (const Utterance& u : all) {
    const auto ok = resumed.add(u);
    ASSERT_TRUE(ok);
    added += *ok ? 1 : 0;
  }
  EXPECT_EQ(added, all.size() - 7);
  EXPECT_EQ(write_training_sums(resumed), uninterrupted);
}

TEST(Accumulate, RefusesSentencesThatChangedOrDoNotFit) {
  const auto sentences = planted(3);
  auto sums = sums_of(sentences);
  const auto before = write_training_sums(sums);
  const auto refusal = [&](auto change) {
    Utterance u = sentences[1];
    change(u);
    const auto ok = sums.add(u);
    EXPECT_FALSE(ok);
    return ok ? std::string() : ok.error().message;
  };
  EXPECT_THAT(refusal([](Utterance& u) { u.signal.values[9] += 1e-9; }),
              testing::AllOf(HasSubstr("s101"), HasSubstr("has changed")));
  EXPECT_THAT(refusal([](Utterance& u) { u.script.phones[1].label = "IH"; }),
              HasSubstr("has changed"));
  EXPECT_THAT(refusal([](Utterance& u) { u.signal.measured.assign(u.signal.frames(), false); }),
              HasSubstr("has changed"));
  EXPECT_THAT(refusal([](Utterance& u) { u.signal.names[0] = "other"; }), HasSubstr("controls"));
  EXPECT_THAT(refusal([](Utterance& u) { u.signal.rate = {30, 1}; }), HasSubstr("rate"));
  EXPECT_THAT(refusal([](Utterance& u) {
                u.id = "new";
                u.signal.values[3] = std::nan("");
              }),
              HasSubstr("finite"));
  EXPECT_EQ(write_training_sums(sums), before);
  const auto again = sums.add(sentences[1]);
  ASSERT_TRUE(again);
  EXPECT_FALSE(*again);
  EXPECT_EQ(write_training_sums(sums), before);
}

TEST(Accumulate, MergingRefusesWhatDoesNotBelongTogether) {
  const auto sentences = planted(4);
  const std::span<const Utterance> all = sentences;
  const auto base = train(all);
  ASSERT_TRUE(base);
  auto sums = sums_of(all.first(2));
  const auto before = write_training_sums(sums);
  const auto refusal = [&](const TrainingSums& other) {
    const auto ok = sums.merge(other);
    EXPECT_FALSE(ok);
    return ok ? std::string() : ok.error().message;
  };
  EXPECT_THAT(refusal(sums_of(all.subspan(1))),
              testing::AllOf(HasSubstr("'s101'"), HasSubstr("twice")));
  EXPECT_THAT(refusal(sums_of(all.subspan(2), &*base)), HasSubstr("dominance"));
  TrainOptions options;
  options.refined.offset_frames = 20;
  EXPECT_THAT(refusal(sums_of(all.subspan(2), nullptr, options)), HasSubstr("offsets"));
  auto others = std::vector<Utterance>(all.begin() + 2, all.end());
  for (Utterance& u : others) u.signal.names[1] = "other";
  EXPECT_THAT(refusal(sums_of(others)), HasSubstr("controls"));
  for (Utterance& u : others) {
    u.signal.names = sentences[0].signal.names;
    u.signal.rate = {25, 1};
  }
  EXPECT_THAT(refusal(sums_of(others)), HasSubstr("rate"));
  EXPECT_EQ(write_training_sums(sums), before);
}

TEST(Accumulate, TheSameIdWithOtherContentCountsAndIsNamed) {
  const auto a = planted(3, 5), b = planted(3, 6);
  auto sums = sums_of(a);
  ASSERT_TRUE(sums.merge(sums_of(b)));
  EXPECT_EQ(sums.sentences(), 6u);
  TrainSummary summary;
  ASSERT_TRUE(train_from_sums(std::move(sums), {}, &summary));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("'s100' occurs with different contents")));
}

TEST(Accumulate, TheBaseMustHaveTheMethod) {
  TrainOptions options;
  options.method = Method::cohen_massaro;
  const auto base = train(planted(4), options);
  ASSERT_TRUE(base);
  const auto sums = TrainingSums::start({}, &*base);
  ASSERT_FALSE(sums);
  EXPECT_THAT(sums.error().message, HasSubstr("cohen-massaro"));
  EXPECT_FALSE(train_from_sums(sums_of(planted(4)), options));
}

}  // namespace accumulate_test
}  // namespace animeme::dam
