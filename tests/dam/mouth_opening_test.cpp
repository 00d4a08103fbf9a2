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

double gap_at(const Signal& signal, std::size_t frame) {
  return inner_gap(signal, frame, *inner_lip_channels(signal.names));
}

// FAP units, at the middle of a phone.
double gap_in(const Signal& signal, const Script& script, std::size_t phone) {
  const double seconds = middle(script.phones[phone + 1]);
  return gap_at(signal, std::size_t(std::lround(seconds * signal.rate.frames_per_second())));
}

double jaw_in(const Signal& signal, const Script& script, std::size_t phone) {
  const double seconds = middle(script.phones[phone + 1]);
  return signal.at(std::size_t(std::lround(seconds * signal.rate.frames_per_second())),
                   channel(signal, 3));
}

TEST(MouthOpening, WhoWantsWhat) {
  const auto alone = [](const std::string& label) { return wish_in_middle({label}, 0); };
  for (const char* open : {"AA", "AE", "AH", "AO", "EH"}) EXPECT_GT(alone(open).wider, 1.1) << open;
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
  EXPECT_GT(mouth(0.45).wider, 1.3);
  EXPECT_EQ(mouth(0.65).wider, 1);
  EXPECT_GT(mouth(0.65).narrow, 2 * mouth(0.45).narrow);
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

TEST(MouthOpening, IyIsHalfOfAaAndAaIsWider) {
  const Script script = script_of({"T", "AA", "T", "IY", "T", "AE", "T", "IH", "S", "AA", "S", "IY",
                                   "SH", "AY", "Z", "UW", "T"},
                                  0.2);
  const Signal learned = spoken(script, 0), now = spoken(script, 1);
  for (const std::size_t aa : {1, 9}) {
    for (const std::size_t iy : {3, 11}) {
      std::cout << "IY of AA: learned " << gap_in(learned, script, iy) / gap_in(learned, script, aa)
                << ", spoken " << gap_in(now, script, iy) / gap_in(now, script, aa) << "\n";
      EXPECT_LT(gap_in(now, script, iy), 0.5 * gap_in(now, script, aa));
      EXPECT_LT(jaw_in(now, script, iy), 0.5 * jaw_in(now, script, aa));
    }
    EXPECT_GT(gap_in(now, script, aa), 1.2 * gap_in(learned, script, aa));
    EXPECT_LT(gap_in(now, script, aa), OpeningOptions().open);
  }
  EXPECT_GT(gap_in(now, script, 5), gap_in(learned, script, 5) * 0.95) << "AE";
  EXPECT_LT(gap_in(now, script, 7), 0.6 * gap_in(now, script, 1)) << "IH";
  for (const std::size_t closed : {8, 10, 12, 14})
    EXPECT_LT(gap_in(now, script, closed), 300) << script.phones[closed + 1].label;
  // Close vowels stay open all the same, and UW is no more than before.
  EXPECT_GT(gap_in(now, script, 3), 200);
  EXPECT_LE(gap_in(now, script, 15), gap_in(learned, script, 15));
  // Larger motion has larger limits.
  const Signal large = spoken(script, 1, 1.5);
  EXPECT_NEAR(gap_in(large, script, 3), 1.5 * gap_in(now, script, 3), 1);
  // More of it: wider vowels, but IY is not shut.
  const Signal twice = spoken(script, 2);
  EXPECT_GT(gap_in(twice, script, 1), gap_in(now, script, 1) + 30);
  EXPECT_GT(gap_in(twice, script, 3), 0.9 * gap_in(now, script, 3));
}

TEST(MouthOpening, ClosuresStay) {
  for (const char* vowel : {"AA", "IY", "AE", "UW"}) {
    const Script script = script_of({"P", vowel, "B", vowel, "M", vowel, "F", vowel, "P"}, 0.12);
    const Signal learned = spoken(script, 0), now = spoken(script, 1);
    for (const std::size_t lips : {0, 2, 4, 8}) {
      const Phone& phone = script.phones[lips + 1];
      const FrameSpan span = frames_near(now, phone, kClosureSearch);
      double least = 1e9, was = 1e9;
      int shut = 0, was_shut = 0;
      for (std::size_t i = span.first; i < span.last; ++i) {
        least = std::min(least, gap_at(now, i));
        was = std::min(was, gap_at(learned, i));
        shut += gap_at(now, i) < kClosedGap ? 1 : 0;
        was_shut += gap_at(learned, i) < kClosedGap ? 1 : 0;
      }
      EXPECT_LE(least, std::max(was, ClosureOptions().target) + 1e-9) << vowel << phone.label;
      EXPECT_NEAR(shut, was_shut, 2) << vowel << phone.label << ", frames of 10 ms";
    }
    // The lip of an F stays at the teeth, and nothing is done to lips in a pause.
    const std::size_t lower = channel(now, 5);
    const auto f = std::size_t(std::lround(middle(script.phones[7]) * 100));
    EXPECT_NEAR(now.at(f, lower), learned.at(f, lower), 10) << vowel;
    EXPECT_EQ(gap_at(now, 0), gap_at(learned, 0));
  }
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
  for (const int fap : {3, 5, 52}) {
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
  // Lips alone, without a jaw: at 0.45 s IY is wanted, at 2 s nothing.
  Signal lips;
  lips.rate = {100, 1};
  lips.names = {"fap4_lower_t_midlip", "fap5_raise_b_midlip"};
  lips.values.assign(2 * 201, -300);
  EXPECT_GT(open_mouth(mouth, 1, 1, lips), 0u);
  EXPECT_NEAR(gap_at(lips, 47), OpeningOptions().close, 10);
  EXPECT_EQ(gap_at(lips, 200), 600);
  lips.values.assign(2 * 201, -300);
  EXPECT_EQ(open_mouth(mouth, 0, 1, lips), 0u);
  EXPECT_EQ(open_mouth(mouth, 1, 0, lips), 0u) << "a mouth at rest";
  EXPECT_EQ(gap_at(lips, 47), 600);
  // A lower lip over the upper one is let be.
  lips.values.assign(2 * 201, 40);
  open_mouth(mouth, 1, 1, lips);
  EXPECT_EQ(gap_at(lips, 47), -80);
}

}  // namespace mouth_opening_test
}  // namespace animeme::dam
