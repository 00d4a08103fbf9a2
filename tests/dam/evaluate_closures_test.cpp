// P B M, F V and rounded sounds with known answers.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/dam/evaluate_pairs.h"

namespace animeme::dam {
namespace evaluate_closures_test {

using sentence_pairs::kFrames;
using sentence_pairs::pair_of;
using sentence_pairs::scale_of;
using sentence_pairs::score_one;
using sentence_pairs::score_with;
using sentence_pairs::script_of;
using sentence_pairs::with_bilabial;

/// Both lips: half of the gap each, the lower one upwards.
double lips(int fap, double gap) { return fap == 4 || fap == 5 ? -gap / 2 : 0; }

TEST(Closures, PlantedFalseClosuresAreCounted) {
  const auto gap_of = [](std::initializer_list<int> closed) {
    return [closed = std::vector<int>(closed)](int fap, int i) {
      return lips(fap, std::count(closed.begin(), closed.end(), i) > 0 ? 0 : 200);
    };
  };
  // B is closed by both; made alone: 50-51 and 70; by both: 60; recorded alone: 80.
  const auto recorded = gap_of({31, 60, 80});
  const auto made = gap_of({31, 50, 51, 60, 70});
  const Evaluation e = score_one(pair_of({4, 5}, with_bilabial(), recorded, made), {4, 5});
  EXPECT_EQ(e.closure.phones, 1u);
  EXPECT_EQ(e.closure.predicted, 1);
  EXPECT_EQ(e.closure.measured, 1);
  EXPECT_EQ(e.closure.false_closures, 2u);
  EXPECT_EQ(e.closure.stray_predicted, 3u);
  EXPECT_EQ(e.closure.stray_measured, 2u);
  EXPECT_NEAR(e.seconds, 4, 1e-9);
  EXPECT_NEAR(e.closure.false_per_minute, 30, 1e-9);
  EXPECT_NEAR(e.closure.stray_measured_per_minute, 30, 1e-9);
  EXPECT_NEAR(e.closure.stray_predicted_per_minute, 45, 1e-9);
}

TEST(Closures, MissedOnesCountOnTheirSideOnly) {
  const auto open = [](int fap, int) { return lips(fap, 200); };
  const auto closes = [](int fap, int i) { return lips(fap, i == 31 ? 40 : 200); };
  Evaluation e = score_one(pair_of({4, 5}, with_bilabial(), closes, open), {4, 5});
  EXPECT_EQ(e.closure.measured, 1);
  EXPECT_EQ(e.closure.predicted, 0);
  EXPECT_EQ(e.closure.onset.count, 0u);
  ScoreOptions strict{.closed_gap = 30, .scale = scale_of({4, 5})};
  e = score_with(pair_of({4, 5}, with_bilabial(), closes, open), strict);
  EXPECT_EQ(e.closure.measured, 0);
}

TEST(Closures, TimingIsThatOfTheThresholdBetweenFrames) {
  // A V-shaped gap, 100 units per frame; its middle is moved by half a frame: 20 ms.
  const auto at = [](double middle) {
    return
        [middle](int fap, int i) { return lips(fap, std::min(400.0, std::abs(i - middle) * 100)); };
  };
  const Evaluation e = score_one(pair_of({4, 5}, with_bilabial(), at(31), at(31.5)), {4, 5});
  // With values at 31: 50 and at 32: 50 the made one stays above 45.
  EXPECT_EQ(e.closure.predicted, 0);
  const auto wide = [](double middle) {
    return
        [middle](int fap, int i) { return lips(fap, std::min(400.0, std::abs(i - middle) * 40)); };
  };
  const Evaluation w = score_one(pair_of({4, 5}, with_bilabial(), wide(31), wide(31.5)), {4, 5});
  EXPECT_EQ(w.closure.predicted, 1);
  ASSERT_EQ(w.closure.onset.count, 1u);
  ASSERT_EQ(w.closure.release.count, 1u);
  EXPECT_NEAR(w.closure.onset.mean, 20, 1e-6);
  EXPECT_NEAR(w.closure.release.mean, 20, 1e-6);
  EXPECT_EQ(w.closure.onset.sd, 0);
}

TEST(Closures, HowLongLipsAreShutByTheLengthOfThePhone) {
  // Frames 5-7 B behind a silence; 10-12 AE; B of 50, 80 and 100 ms around frames 31, 56 and 81.
  Script script;
  const auto add = [&](double start, double end, const char* label) {
    script.phones.push_back({start, end, label, label == kSilence ? "" : "word"});
  };
  add(0, 0.2, "SIL");
  add(0.2, 0.3, "B");
  add(0.3, 1.22, "AE");
  add(1.22, 1.27, "B");
  add(1.27, 2.2, "AE");
  add(2.2, 2.28, "B");
  add(2.28, 3.2, "AE");
  add(3.2, 3.3, "B");
  add(3.3, 4, "AE");
  // A V-shaped gap: below 45 for 90 / slope frames of 40 ms.
  const auto valleys = [](double slope) {
    return [slope](int fap, int i) {
      double gap = 400;
      for (const int middle : {6, 31, 56, 81}) gap = std::min(gap, std::abs(i - middle) * slope);
      return lips(fap, gap);
    };
  };
  const Evaluation e = score_one(pair_of({4, 5}, script, valleys(50), valleys(90)), {4, 5});
  EXPECT_EQ(e.closure.phones, 4u);
  ASSERT_EQ(e.closure.durations.size(), 3u);
  for (const ClosureDurationScore& shut : e.closure.durations) {
    EXPECT_EQ(shut.phones, 1u) << shut.from;
    EXPECT_NEAR(shut.measured, 72, 1e-9) << shut.from;
    EXPECT_NEAR(shut.predicted, 40, 1e-9) << shut.from;
  }
  EXPECT_EQ(e.closure.durations[1].from, 0.060);
  EXPECT_EQ(e.closure.durations[1].to, 0.100);
  // What never closes is shut for no time; what never opens counts up to 0.2 s on each side.
  const auto open = [](int fap, int) { return lips(fap, 200); };
  const auto shut = [](int fap, int) { return lips(fap, 0); };
  const Evaluation never = score_one(pair_of({4, 5}, script, open, shut), {4, 5});
  EXPECT_EQ(never.closure.durations[2].measured, 0);
  EXPECT_NEAR(never.closure.durations[2].predicted, 400, 1e-9);
}

TEST(Lips, ContactOfFAndV) {
  std::vector<std::string> labels(36, "AE");
  labels[10] = labels[20] = labels[30] = "F";  // 1.2 s, 2.2 s, 3.2 s: frames 30, 55, 80
  const auto peaks = [](double a, double b, double c) {
    return [=](int, int i) { return i == 31 ? a : i == 56 ? b : i == 81 ? c : -100.0; };
  };
  const Evaluation e =
      score_one(pair_of({5}, script_of(labels), peaks(40, 60, 10), peaks(40, 0, 14)), {5});
  EXPECT_EQ(e.contact.phones, 3u);
  EXPECT_NEAR(e.contact.level, 40 - 45, 1e-9);
  EXPECT_EQ(e.contact.measured, 1);
  EXPECT_EQ(e.contact.predicted, 1);
  EXPECT_NEAR(e.contact.difference, (0 - 60 + 4) / 3.0, 1e-9);
  const Evaluation low =
      score_one(pair_of({5}, script_of(labels), peaks(40, 60, 10), peaks(-6, 0, -4)), {5});
  EXPECT_NEAR(low.contact.predicted, 2 / 3.0, 1e-9);
}

TEST(Lips, RoundedSoundsAreNarrower) {
  std::vector<std::string> labels(36, "AE");
  labels[10] = "UW";  // frames 30 to 32
  labels[20] = "W";   // frames 55 to 57
  const auto width = [](double uw, double w) {
    return [=](int, int i) { return (i == 31 ? uw : i == 56 ? w : 0.0) / 2; };
  };
  const Evaluation e =
      score_one(pair_of({6, 7}, script_of(labels), width(-100, -50), width(-80, -40)), {6, 7});
  EXPECT_EQ(e.rounding.phones, 2u);
  const double mean = -150.0 / kFrames;  // of the recorded width
  EXPECT_NEAR(e.rounding.measured, mean + 75, 1e-9);
  EXPECT_NEAR(e.rounding.predicted, mean + 60, 1e-9);
  EXPECT_NEAR(e.rounding.rmse, std::sqrt((400 + 100) / 2.0), 1e-9);
  EXPECT_NEAR(e.rounding.correlation, 1, 1e-9);
}

}  // namespace evaluate_closures_test
}  // namespace animeme::dam
