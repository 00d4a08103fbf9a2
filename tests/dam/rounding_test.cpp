#include "dam/signal/rounding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "tests/dam/stream_parity.h"

namespace animeme::dam {
namespace rounding_test {

// Phones of 0.15 s between pauses.
Script script_of(const std::vector<std::string>& labels) {
  Script script{{{0, 0.4, "SIL", ""}}};
  double at = 0.4;
  for (const std::string& label : labels) {
    script.phones.push_back({at, at + 0.15, label, "word"});
    at += 0.15;
  }
  script.phones.push_back({at, at + 0.5, "SIL", ""});
  return script;
}

double middle(const Script& script, std::size_t phone) {
  return (script.phones[phone + 1].start + script.phones[phone + 1].end) / 2;
}

std::size_t channel(const Signal& signal, int fap) {
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    if (fap_of_channel(signal.names[c]) == fap) return c;
  }
  ADD_FAILURE() << "no FAP " << fap;
  return 0;
}

const Model& model() {
  static const Model built = *builtin_model();
  return built;
}

TEST(Rounding, WhoWantsIt) {
  const auto round = [](const std::vector<std::string>& labels, std::size_t phone) {
    const Script script = script_of(labels);
    return LipRounding(script)(middle(script, phone));
  };
  EXPECT_GT(round({"T", "UW", "T"}, 1), 0.95);
  EXPECT_GT(round({"W"}, 0), 0.95);
  EXPECT_GT(round({"SH"}, 0), 0.25);
  EXPECT_LT(round({"T", "AO", "T"}, 1), round({"T", "UW", "T"}, 1)) << "open vowels less";
  for (const char* spread : {"IY", "EY", "AA", "AE"}) {
    EXPECT_LT(round({"T", spread, "T"}, 1), 0.05) << spread;
    EXPECT_LT(round({"UW", spread, "UW"}, 1), 0.35) << spread;
  }
  EXPECT_LT(round({"IY", "T", "IY"}, 1), 0.05);
  EXPECT_GT(round({"UW", "T", "UW"}, 1), 0.3) << "T leaves it to its neighbours";
  EXPECT_LT(round({"UW", "F", "UW"}, 1), 0.6) << "the lip is at the teeth";
  const Script diphthong = script_of({"AY", "OY", "AW"});
  const LipRounding lips(diphthong);
  EXPECT_GT(lips(diphthong.phones[2].start + 0.04), lips(diphthong.phones[2].end - 0.03)) << "OY";
  EXPECT_EQ(lips(0), 0);
  EXPECT_EQ(lips(100), 0);
  EXPECT_EQ(LipRounding({})(1), 0);
}

TEST(Rounding, UwIsForwardAndAsNarrowAsLearned) {
  const Script script =
      script_of({"T", "UW", "T", "IY", "T", "W", "IY", "M", "OW", "N", "M", "UW"});
  SynthesisOptions options;
  const auto learned = synthesise(model(), script, options);
  options.articulation = 1;
  const auto spoken = synthesise(model(), script, options);
  ASSERT_TRUE(learned && spoken);
  // Of the mouth's width at rest (FAP 6 and 7 are in 1024ths of it).
  const auto width = [&](const Signal& signal, std::size_t phone) {
    const auto frame = std::size_t(std::lround(middle(script, phone) * 25));
    return 1 + (signal.at(frame, channel(signal, 6)) + signal.at(frame, channel(signal, 7))) / 1024;
  };
  EXPECT_LT(width(*spoken, 1), 0.93 * width(*spoken, 3));
  EXPECT_EQ(width(*spoken, 1), width(*learned, 1));
  const auto frame = std::size_t(std::lround(middle(script, 1) * 25));
  for (const int fap : {16, 17}) {
    EXPECT_GT(spoken->at(frame, channel(*spoken, fap)),
              learned->at(frame, channel(*learned, fap)) + 150);
  }
  // All else is as before.
  Signal rounded = *learned;
  ASSERT_GT(add_rounding(
                LipRounding(script), 1, [](double) { return 1.0; }, rounded),
            0u);
  EXPECT_NE(rounded.values, learned->values);
  for (std::size_t i = 0; i < rounded.frames(); ++i) {
    for (const int fap : {3, 4, 5, 6, 7, 8, 10, 51, 52, 53, 54}) {
      const std::size_t c = channel(rounded, fap);
      ASSERT_EQ(rounded.at(i, c), learned->at(i, c)) << fap;
    }
  }
  EXPECT_EQ(spoken->at(0, channel(*spoken, 17)), learned->at(0, channel(*learned, 17)))
      << "at rest";
  options.style = 0;
  const auto still = synthesise(model(), script, options);
  ASSERT_TRUE(still);
  EXPECT_EQ(still->at(frame, channel(*still, 17)), model().controls[channel(*still, 17)].rest);
}

TEST(Rounding, StreamsAreTheWholeClip) {
  const Script script =
      script_of({"W", "AO", "T", "UW", "IY", "SH", "OW", "P", "UH", "T", "UW", "K"});
  StreamOptions options;
  options.synthesis.articulation = 1;
  expect_stream_is_whole(model(), script, options);
}

TEST(Rounding, OtherRigsAndAmounts) {
  Signal signal;
  signal.names = {"jawOpen"};
  signal.values = {0.5};
  const auto shown = [](double) { return 1.0; };
  EXPECT_EQ(add_rounding(LipRounding(script_of({"UW"})), 1, shown, signal), 0u);
  EXPECT_EQ(signal.values[0], 0.5);
  SynthesisOptions options;
  for (const double bad : {-0.1, 2.1, std::nan("")}) {
    options.articulation = bad;
    EXPECT_FALSE(synthesise(model(), script_of({"UW"}), options)) << bad;
  }
}

}  // namespace rounding_test
}  // namespace animeme::dam
