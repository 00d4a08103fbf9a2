#include "dam/speaking/stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "dam/signal/closure.h"
#include "dam/training/train.h"
#include "tests/dam/dam_support.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace stream_test {

using testing::HasSubstr;

const Corpus& sample() {
  static const Corpus corpus = *read_corpus(test::data_dir() / "grid_s1_sample");
  return corpus;
}

/// Phones of a bounded reach and no choice that depends on phones far away.
Model quick_model(Method method) {
  TrainOptions options;
  options.method = method;
  options.max_iterations = 3;
  return *train(std::span(sample().utterances).first(10), options);
}

const Model& bounded_model() {
  static const Model model = quick_model(Method::dam);
  return model;
}

/// Sentences of the sample one after the other.
Script long_script() {
  Script script;
  double t = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    for (Phone phone : sample().utterances[i].script.phones) {
      phone.start += t;
      phone.end += t;
      script.phones.push_back(phone);
    }
    t = script.phones.back().end;
  }
  return script;
}

/// All frames that come out of a stream; `pull_every` phones are pushed at a time.
Signal stream_of(const Model& model, const Script& script, const StreamOptions& options,
                 std::size_t pull_every = 1, double* latest = nullptr) {
  SpeechStream stream(model, options);
  Signal all;
  const auto append = [&](const Result<Signal>& piece) {
    ASSERT_TRUE(piece) << piece.error().describe();
    if (all.names.empty()) {
      all = *piece;
      return;
    }
    EXPECT_EQ(piece->frames() == 0 || piece->first_frame == all.frames(), true);
    all.values.insert(all.values.end(), piece->values.begin(), piece->values.end());
  };
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    EXPECT_TRUE(stream.push(script.phones[i]));
    if (i % pull_every != 0) continue;
    append(stream.pull());
    if (latest != nullptr && i > 3)
      *latest = std::max(*latest, script.phones[i].end - all.rate.seconds(double(all.frames())));
  }
  append(stream.finish());
  return all;
}

TEST(Stream, GivesTheFramesOfTheWholeClip) {
  const Script script = long_script();
  for (const Method method : {Method::dam, Method::cohen_massaro}) {
    const Model model = quick_model(method);
    for (const std::uint32_t fps : {25u, 60u})
      for (const std::size_t pull_every : {1u, 7u}) {
        StreamOptions options;
        options.synthesis.rate = {fps, 1};
        options.synthesis.tail = 0.3;
        const auto whole = synthesise(model, script, options.synthesis);
        ASSERT_TRUE(whole);
        const Signal streamed = stream_of(model, script, options, pull_every);
        ASSERT_EQ(streamed.values.size(), whole->values.size());
        EXPECT_EQ(streamed.values, whole->values) << fps << " frames a second";
      }
  }
}

// Methods that choose modes by the whole sentence give other frames, but as many.
TEST(Stream, EveryMethodGivesAllFrames) {
  const Script script = long_script();
  for (const Method method : methods()) {
    const Model model = quick_model(method);
    const auto whole = synthesise(model, script, {});
    ASSERT_TRUE(whole);
    const Signal streamed = stream_of(model, script, {}, 3);
    EXPECT_EQ(streamed.values.size(), whole->values.size()) << method_name(method);
    EXPECT_GT(exact_look_ahead(model), 0) << method_name(method);
  }
}

TEST(Stream, WaitsNoLongerThanItSays) {
  double latest = 0;
  StreamOptions options;
  stream_of(bounded_model(), long_script(), options, 1, &latest);
  double two_phones = 0;
  const Script script = long_script();
  for (std::size_t i = 2; i < script.phones.size(); ++i)
    two_phones = std::max(two_phones, script.phones[i].end - script.phones[i - 2].end);
  EXPECT_LE(latest, exact_look_ahead(bounded_model()) + two_phones + 0.08);
}

TEST(Stream, LowLatencyIsEarlyAndSmooth) {
  StreamOptions options;
  options.look_ahead = 0.1;
  double latest = 0;
  const Signal streamed = stream_of(bounded_model(), long_script(), options, 1, &latest);
  EXPECT_LT(latest, 0.1 + 0.08);
  const auto whole = synthesise(bounded_model(), long_script(), options.synthesis);
  ASSERT_EQ(streamed.frames(), whole->frames());
  // Corrections do not jump: no change from frame to frame is much larger than the largest of the
  // whole clip, which itself follows sounds.
  for (std::size_t c = 0; c < streamed.names.size(); ++c) {
    double usual = 0, largest = 0, error = 0, power = 0;
    for (std::size_t i = 1; i < streamed.frames(); ++i) {
      usual = std::max(usual, std::abs(whole->at(i, c) - whole->at(i - 1, c)));
      largest = std::max(largest, std::abs(streamed.at(i, c) - streamed.at(i - 1, c)));
      error += std::pow(streamed.at(i, c) - whole->at(i, c), 2);
      power += std::pow(whole->at(i, c) - bounded_model().controls[c].rest, 2);
    }
    EXPECT_LT(largest, 1.6 * usual + 1) << streamed.names[c];
    EXPECT_LT(error, 0.25 * power + 1) << streamed.names[c];
  }
}

TEST(Stream, RefusesPhonesOutOfOrder) {
  SpeechStream stream(bounded_model(), {});
  ASSERT_TRUE(stream.push({0.2, 0.3, "AY", ""}));
  EXPECT_THAT(stream.push({0.25, 0.4, "T", ""}).error().message,
              HasSubstr("before the previous one"));
  EXPECT_FALSE(stream.push({0.4, 0.4, "T", ""}));
  EXPECT_FALSE(stream.push({0.4, std::nan(""), "T", ""}));
  EXPECT_THAT(stream.push({0.4, 0.5, "XX", ""}).error().message, HasSubstr("not known"));
  EXPECT_TRUE(stream.push({0.5, 0.6, "T", ""}));  // the gap is silence
  EXPECT_EQ(stream.finish()->frames(), 15u);
  EXPECT_THAT(stream.push({0.6, 0.7, "T", ""}).error().message, HasSubstr("after the end"));
}

TEST(Stream, ChecksItsOptions) {
  StreamOptions options;
  options.look_ahead = -1;
  EXPECT_FALSE(SpeechStream(bounded_model(), options).pull());
  options = {};
  options.cross_fade = std::nan("");
  EXPECT_FALSE(SpeechStream(bounded_model(), options).push({0, 1, "AY", ""}));
  options = {};
  options.synthesis.style = 2;
  EXPECT_FALSE(SpeechStream(bounded_model(), options).finish());
}

TEST(Stream, WithoutPhonesThereIsNothing) {
  SpeechStream stream(bounded_model(), {});
  EXPECT_EQ(stream.pull()->frames(), 0u);
  EXPECT_EQ(stream.finish()->frames(), 0u);
}

}  // namespace stream_test
}  // namespace animeme::dam
