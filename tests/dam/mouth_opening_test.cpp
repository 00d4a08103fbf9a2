#include "dam/signal/mouth_opening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "dam/model/builtin.h"
#include "dam/script/ipa.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "tests/dam/stream_parity.h"

namespace animeme::dam {
namespace mouth_opening_test {

// Phones between pauses; P, T, S and the like last 0.1 s, others `vowel` seconds.
Script script_of(const std::vector<std::string>& labels, double vowel = 0.15) {
  Script script{{{0, 0.4, "SIL", ""}}};
  double at = 0.4;
  for (const std::string& label : labels) {
    const PhoneInfo* info = find_phone(label);
    const double end = at + (info != nullptr && (info->vowel || label == "SIL") ? vowel : 0.1);
    script.phones.push_back({at, end, label, ""});
    at = end;
  }
  script.phones.push_back({at, at + 0.5, "SIL", ""});
  return script;
}

double middle(const Phone& phone) { return (phone.start + phone.end) / 2; }

MouthOpening::Target wish_in_middle(const std::vector<std::string>& labels, std::size_t phone) {
  const Script script = script_of(labels);
  return MouthOpening(script)(middle(script.phones[phone + 1]));
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

Signal spoken(const Script& script, double articulation, double style = 1, int rate = 100) {
  SynthesisOptions options;
  options.rate = {std::uint32_t(rate), 1};
  options.articulation = articulation;
  options.style = style;
  const auto signal = synthesise(model(), script, options);
  EXPECT_TRUE(signal);
  return *signal;
}

// FAP units, at the middle of a phone.
double jaw_in(const Signal& signal, const Script& script, std::size_t phone) {
  const double seconds = middle(script.phones[phone + 1]);
  return signal.at(std::size_t(std::lround(seconds * signal.rate.frames_per_second())),
                   channel(signal, 3));
}

TEST(MouthOpening, WhoWantsWhat) {
  const auto alone = [](const std::string& label) { return wish_in_middle({label}, 0); };
  for (const char* open : {"AA", "AE", "AH", "AO", "EH"})
    EXPECT_GT(alone(open).wider, 1.05) << open;
  for (const char* other : {"IY", "IH", "UW", "UH", "S", "SH", "Y"})
    EXPECT_EQ(alone(other).wider, 1) << other;
  EXPECT_GT(alone("AA").wider, alone("EH").wider);
  EXPECT_LT(alone("AX").wider, 1.05);
  for (const char* close : {"IY", "UW", "Y", "W"})
    EXPECT_NEAR(1 / alone(close).narrow, OpeningOptions().close, 1e-9) << close;
  for (const char* together : {"S", "Z", "SH", "ZH", "CH", "JH"})
    EXPECT_GT(1 / alone("AX").narrow, 1 / wish_in_middle({together}, 0).narrow) << together;
  for (const char* lips : {"P", "B", "M", "F", "V"}) EXPECT_FALSE(alone(lips).any()) << lips;
  // T leaves it to its neighbours, in the middle to both.
  const double iy = alone("IY").narrow, aa = alone("AA").narrow;
  EXPECT_NEAR(wish_in_middle({"IY", "T", "IY"}, 1).narrow, iy, 1e-12);
  EXPECT_NEAR(wish_in_middle({"IY", "T", "AA"}, 1).narrow, (iy + aa) / 2, 1e-12);
  // Diphthongs go from one to the other.
  const Script diphthong = script_of({"AY"}, 0.3);
  const MouthOpening mouth(diphthong);
  EXPECT_GT(mouth(0.45).wider, 1.15);
  EXPECT_EQ(mouth(0.65).wider, 1);
  EXPECT_GT(mouth(0.65).narrow, 1.7 * mouth(0.45).narrow);
  // Nobody speaks.
  EXPECT_FALSE(mouth(0).any());
  EXPECT_FALSE(mouth(100).any());
  EXPECT_FALSE(MouthOpening({})(1).any());
}

// Whatever language a vowel is of: the lower, the wider.
TEST(MouthOpening, FollowsTheHeightOfAnyVowel) {
  const auto of_letter = [](const char* letter) {
    const auto phones = parse_ipa(letter);
    EXPECT_TRUE(phones && !phones->empty()) << letter;
    return wish_in_middle({std::string((*phones)[0].label)}, 0);
  };
  const std::vector<std::vector<const char*>> heights = {{"i", "y", "ɨ", "u"},
                                                         {"a", "ɐ", "ɑ", "æ", "ɒ"}};
  for (const char* close : heights[0]) {
    EXPECT_EQ(of_letter(close).wider, 1) << close;
    for (const char* open : heights[1]) {
      EXPECT_GT(of_letter(open).wider, 1) << open;
      EXPECT_GT(of_letter(close).narrow, 1.3 * of_letter(open).narrow) << close << open;
    }
  }
  EXPECT_GT(of_letter("i").narrow, of_letter("ɛ").narrow);
  EXPECT_GT(of_letter("ɛ").narrow, of_letter("a").narrow);
  EXPECT_EQ(of_letter("ʃ").narrow, of_letter("ɕ").narrow) << "teeth";
}

TEST(MouthOpening, TheJawFollowsTheVowelAndTheLipsStay) {
  const Script script = script_of({"T", "AA", "T", "IY", "T", "AE", "T", "IH", "S", "AA", "S", "IY",
                                   "SH", "AY", "Z", "UW", "T"},
                                  0.2);
  const Signal learned = spoken(script, 0), now = spoken(script, 1);
  for (const std::size_t aa : {1, 9}) {
    EXPECT_GT(jaw_in(now, script, aa), 1.02 * jaw_in(learned, script, aa));
    EXPECT_LT(jaw_in(now, script, aa), OpeningOptions().open);
    for (const std::size_t iy : {3, 11}) {
      EXPECT_LT(jaw_in(now, script, iy), 0.8 * jaw_in(now, script, aa));
      EXPECT_LE(jaw_in(now, script, iy), jaw_in(learned, script, iy));
    }
  }
  for (const std::size_t teeth : {8, 10, 12, 14})
    EXPECT_LT(jaw_in(now, script, teeth), OpeningOptions().teeth) << script.phones[teeth + 1].label;
  // Nothing but the jaw and the lips' forward motion changes.
  for (std::size_t c = 0; c < now.names.size(); ++c) {
    const int fap = fap_of_channel(now.names[c]);
    if (fap == 3 || fap == 16 || fap == 17) continue;
    for (std::size_t i = 0; i < now.frames(); ++i)
      ASSERT_EQ(now.at(i, c), learned.at(i, c)) << now.names[c];
  }
  // More of it: a lower jaw in AA, but IY is not shut.
  const Signal twice = spoken(script, 2);
  EXPECT_GT(jaw_in(twice, script, 1), jaw_in(now, script, 1) + 5);
  EXPECT_GT(jaw_in(twice, script, 3), 0.9 * jaw_in(now, script, 3));
}

TEST(MouthOpening, MovesAsSmoothlyAsWhatIsLearned) {
  // The wish itself: no faster than a raised cosine over `turn` seconds.
  const Script script = script_of({"AA", "IY", "AE", "S", "AA", "IY", "P", "AA", "Y", "AA"}, 0.07);
  const MouthOpening mouth(script);
  const OpeningOptions options;
  for (double t = 0; t < script.duration(); t += 0.001) {
    const auto a = mouth(t), b = mouth(t + 0.001);
    const double most = 0.001 * std::numbers::pi / 2 / options.turn * 1.01;
    ASSERT_LE(std::abs(b.wider - a.wider), 2 * most * options.wider) << t;
    ASSERT_LE(std::abs(b.narrow - a.narrow), 2 * most / options.teeth) << t;
    ASSERT_GE(a.wider, 1 - 1e-12);
    ASSERT_LE(a.wider, 1 + options.wider + 1e-12);
    ASSERT_LE(a.narrow, 1 / options.teeth + 1e-12);
  }
  // What comes of it: speeds of lips and jaw.
  const Signal learned = spoken(script, 0), now = spoken(script, 1);
  const auto fastest = [](const Signal& signal, int fap) {
    const std::size_t c = channel(signal, fap);
    double most = 0;
    for (std::size_t i = 1; i < signal.frames(); ++i)
      most = std::max(most, std::abs(signal.at(i, c) - signal.at(i - 1, c)));
    return 100 * most;  // units per second
  };
  for (const int fap : {3}) {
    std::cout << "FAP " << fap << " at most " << fastest(learned, fap) << ", now "
              << fastest(now, fap) << " units a second\n";
    EXPECT_LT(fastest(now, fap), 1.4 * fastest(learned, fap)) << fap;
  }
}

TEST(MouthOpening, StreamsAreTheWholeClip) {
  Script script = script_of({"S", "IY", "N", "T", "K", "SIL", "AA", "T", "P", "HH", "AY", "IY"});
  // Held sounds without a wish, and pauses about as long as they are bridged.
  double at = script.duration();
  for (const auto& [label, seconds] : std::vector<std::pair<std::string, double>>{{"N", 1.4},
                                                                                  {"AA", 0.1},
                                                                                  {"N", 0.31},
                                                                                  {"IY", 0.1},
                                                                                  {"SIL", 0.29},
                                                                                  {"AE", 0.08},
                                                                                  {"SIL", 0.16},
                                                                                  {"L", 0.05},
                                                                                  {"UW", 0.2},
                                                                                  {"SIL", 2},
                                                                                  {"AA", 0.2}}) {
    script.phones.push_back({at, at + seconds, label, ""});
    at += seconds;
  }
  StreamOptions options;
  options.synthesis.articulation = 1;
  options.synthesis.rate = {50, 1};
  expect_stream_is_whole(model(), script, options);
}

TEST(MouthOpening, OtherRigsAndStillFaces) {
  const MouthOpening mouth(script_of({"IY"}));
  Signal rig;
  rig.names = {"jawOpen", "mouthClose"};
  rig.values = {0.5, 0.1};
  EXPECT_EQ(open_mouth(mouth, 1, 1, rig), 0u);
  EXPECT_EQ(rig.values[0], 0.5);
  // At 0.45 s IY is wanted, at 2 s nothing.
  Signal jaw;
  jaw.rate = {100, 1};
  jaw.names = {"fap3_open_jaw"};
  const auto from = [&](double value) { jaw.values.assign(201, value); };
  from(500);
  EXPECT_GT(open_mouth(mouth, 1, 1, jaw), 0u);
  EXPECT_NEAR(jaw.at(47, 0), OpeningOptions().close, 10);
  EXPECT_EQ(jaw.at(200, 0), 500);
  from(500);
  EXPECT_EQ(open_mouth(mouth, 0, 1, jaw), 0u);
  EXPECT_EQ(open_mouth(mouth, 1, 0, jaw), 0u) << "a mouth at rest";
  EXPECT_EQ(jaw.at(47, 0), 500);
  from(-40);
  EXPECT_EQ(open_mouth(mouth, 1, 1, jaw), 0u) << "clenched";
  EXPECT_EQ(jaw.at(47, 0), -40);
}

TEST(MouthOpening, AModelSaysWhatItLearnedUnlessToldOtherwise) {
  // Somebody who opens IY and S wide, and the built-in model, whose articulation is 1.
  const Script script = script_of({"T", "IY", "S", "IY", "T", "AA"}, 0.2);
  SynthesisOptions options;
  const auto says = [&](const Model& who, std::optional<double> articulation) {
    options.articulation = articulation;
    return synthesise(who, script, options)->values;
  };
  EXPECT_EQ(says(model(), std::nullopt), says(model(), 1));
  EXPECT_NE(says(model(), std::nullopt), says(model(), 0));
  Model own = model();
  own.articulation = 0;
  EXPECT_EQ(says(own, std::nullopt), says(own, 0));
  // It is kept in files, which without it are what they were.
  EXPECT_EQ(read_model(write_model(model()))->articulation, 1);
  EXPECT_EQ(read_model(write_model(own))->articulation, 0);
  EXPECT_EQ(write_model(own).size() + 8, write_model(model()).size());
  const auto bytes = builtin_model_bytes();
  const auto written = write_model(own);
  EXPECT_TRUE(std::equal(written.begin(), written.end(), bytes.begin(), bytes.end()));
  own.articulation = 2.5;
  EXPECT_FALSE(validate(own));
}

}  // namespace mouth_opening_test
}  // namespace animeme::dam
