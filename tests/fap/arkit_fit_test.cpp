// FAPs to ARKit and back.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fap/arkit.h"
#include "fap/fill.h"
#include "fap/tables.h"
#include "fap/text.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::fap {
namespace arkit_fit_test {

std::size_t channel(std::string_view name) {
  const std::optional<int> found = find_arkit(name);
  EXPECT_TRUE(found) << name;
  return std::size_t(found.value_or(0));
}

Frame shown(const ArkitFrame& weights) { return arkit_to_fap(weights, kAllArkit); }

// Squared differences and squared values in lengths on the head of the table.
void add_residual(const Frame& a, const Frame& b, double& error, double& power) {
  const auto length = [](Unit unit) {
    switch (unit) {
      case Unit::irisd:
        return 0.993;
      case Unit::es:
        return 5.903;
      case Unit::ens:
        return 4.821;
      case Unit::mns:
        return 2.120;
      case Unit::mw:
        return 5.070;
      default:
        return 0.0;
    }
  };
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    const double unit = length(info(fap).unit);
    const double value = a.value[std::size_t(fap)];
    error += std::pow(unit * (value - b.value[std::size_t(fap)]), 2);
    power += std::pow(unit * value, 2);
  }
}

double residual(const Frame& a, const Frame& b) {
  double error = 0;
  double power = 0;
  add_residual(a, b, error, power);
  return std::sqrt(error / power);
}

TEST(ArkitFit, AFaceAtRestHasNoWeights) {
  const ArkitFrame weights = ArkitFitter().fit(shown({}));
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_EQ(weights[i], 0) << kArkitNames[i];
}

TEST(ArkitFit, EyesHeadAndTongueAreExact) {
  ArkitFrame given{};
  given[channel("eyeLookOutLeft")] = 0.4;
  given[channel("eyeLookInRight")] = 0.3;
  given[channel("eyeLookUpLeft")] = 0.2;
  given[channel("eyeLookDownRight")] = 0.6;
  given[channel("tongueOut")] = 0.5;
  given[channel("headYaw")] = 0.2;
  given[channel("headPitch")] = -0.1;
  given[channel("headRoll")] = 0.05;
  const ArkitFrame found = ArkitFitter().fit(shown(given));
  for (const char* name : {"eyeLookOutLeft", "eyeLookInLeft", "eyeLookInRight", "eyeLookOutRight",
                           "eyeLookUpLeft", "eyeLookDownLeft", "eyeLookDownRight", "eyeLookUpRight",
                           "tongueOut", "headYaw", "headPitch", "headRoll"}) {
    EXPECT_NEAR(found[channel(name)], given[channel(name)], 1e-3) << name;
  }
  // The lids went along with the eyes: nothing is left for a blink.
  EXPECT_LT(found[channel("eyeBlinkRight")], 0.02);
}

// Each shape at half: its face comes back, and the shape itself is the one that is used most.
TEST(ArkitFit, EveryShapeIsFound) {
  for (std::size_t i = 0; i < std::size_t(kArkitShapeCount); ++i) {
    ArkitFrame given{};
    given[i] = 0.5;
    const Frame face = shown(given);
    const ArkitFrame found = ArkitFitter().fit(face);
    EXPECT_NEAR(found[i], 0.5, 0.15) << kArkitNames[i];
    for (std::size_t j = 0; j < std::size_t(kArkitShapeCount); ++j) {
      EXPECT_TRUE(j == i || found[j] < 0.12) << kArkitNames[j] << " for " << kArkitNames[i];
    }
    EXPECT_LT(residual(face, shown(found)), 0.1) << kArkitNames[i];
  }
}

TEST(ArkitFit, MirroredFacesHaveMirroredWeights) {
  std::mt19937 random(5);
  ArkitFrame left{};
  ArkitFrame right{};
  for (int i = 0; i < kArkitShapeCount; ++i) {
    const std::string name(kArkitNames[std::size_t(i)]);
    std::string other = name;
    if (name.ends_with("Left")) other.replace(name.size() - 4, 4, "Right");
    if (name.ends_with("Right")) other.replace(name.size() - 5, 5, "Left");
    if (name.starts_with("eyeLook")) continue;  // one eye cannot look both ways
    const double weight = double(random() % 1000) / 4000;
    left[std::size_t(i)] = weight;
    right[channel(other)] = weight;
  }
  const ArkitFrame a = ArkitFitter().fit(shown(left));
  const ArkitFrame b = ArkitFitter().fit(shown(right));
  for (int i = 0; i < kArkitShapeCount; ++i) {
    std::string other(kArkitNames[std::size_t(i)]);
    if (other.ends_with("Left")) {
      other.replace(other.size() - 4, 4, "Right");
    } else if (other.ends_with("Right")) {
      other.replace(other.size() - 5, 5, "Left");
    }
    EXPECT_NEAR(a[std::size_t(i)], b[channel(other)], 2e-3) << other;
  }
}

TEST(ArkitFit, ClosedEyesAreClosed) {
  Frame frame = shown({});
  frame.value[19] = frame.value[20] = 1024;
  const ArkitFrame found = ArkitFitter().fit(frame);
  EXPECT_GT(found[channel("eyeBlinkLeft")], 0.95);
  EXPECT_GT(found[channel("eyeBlinkRight")], 0.95);
}

TEST(ArkitFit, MissingFapsHaveNoSay) {
  Frame frame;
  frame.set(19, 500);
  const ArkitFrame found = ArkitFitter().fit(frame);
  EXPECT_GT(found[channel("eyeBlinkLeft")], 0.3);
  for (const char* name : {"jawOpen", "mouthSmileLeft", "eyeBlinkRight", "headYaw"}) {
    EXPECT_EQ(found[channel(name)], 0) << name;
  }
}

TEST(ArkitFit, AnyNumbersStayWithinBounds) {
  std::mt19937 random(11);
  ArkitFitter fitter;
  for (int round = 0; round < 50; ++round) {
    Frame frame;
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (random() % 4 != 0) frame.set(fap, std::int32_t(random()));
    }
    const ArkitFrame found = fitter.fit(frame);
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_TRUE(std::isfinite(found[i])) << kArkitNames[i];
      if (i >= std::size_t(kArkitShapeCount)) continue;
      ASSERT_GE(found[i], 0) << kArkitNames[i];
      ASSERT_LE(found[i], 1) << kArkitNames[i];
    }
  }
}

// Steadiness: a jump of the face is followed, but a trembling of one unit hardly is.
TEST(ArkitFit, SteadinessFollowsMotion) {
  ArkitFitter fitter;
  ArkitFrame open{};
  open[channel("jawOpen")] = 0.6;
  (void)fitter.fit(shown({}));
  double seen = 0;
  for (int i = 0; i < 3; ++i) seen = fitter.fit(shown(open))[channel("jawOpen")];
  EXPECT_NEAR(seen, 0.6, 0.06);
}

// Speech of a tracked mouth, of which depth is a guess and the cheeks were not measured: no pair of
// shapes undoes itself, none that nobody speaks with is taken, and few are in use.
TEST(ArkitFit, SpeechTakesFewShapes) {
  std::mt19937 random(3);
  const auto noise = [&](int size) { return int(random() % unsigned(2 * size)) - size; };
  for (const auto& [rounded, open] : {std::pair{0.6, 0.1}, {0.4, 0.2}, {0.0, 0.3}}) {
    ArkitFrame given{};
    given[channel("mouthPucker")] = rounded;
    given[channel("jawOpen")] = open;
    Frame face = shown(given);
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      const bool mouth = (fap >= 3 && fap <= 18) || (fap >= 51 && fap <= 60);
      if (mouth) face.value[std::size_t(fap)] += noise(50);
      if (!mouth || fap == 14 || fap == 18) face.value[std::size_t(fap)] = 0;
    }
    for (const std::size_t depth : {16, 17}) face.value[depth] += noise(50);
    const ArkitFrame found = ArkitFitter().fit(face);
    int used = 0;
    for (std::size_t i = 0; i < std::size_t(kArkitShapeCount); ++i) used += found[i] > 0.02;
    EXPECT_LE(used, 9);
    EXPECT_NEAR(found[channel("mouthPucker")], rounded, 0.15);
    EXPECT_NEAR(found[channel("jawOpen")], open, 0.1);
    for (const char* name : {"mouthFrownLeft", "mouthFrownRight", "cheekPuff", "noseSneerLeft"}) {
      EXPECT_LT(found[channel(name)], 0.05) << name;
    }
    for (const char* shape : {"mouth", "jaw"}) {
      const std::string name = shape;
      EXPECT_EQ(std::min(found[channel(name + "Left")], found[channel(name + "Right")]), 0);
    }
  }
}

// Recorded and synthesised motion of others, none of it made from ARKit shapes. The bounds are
// those of least squares without memory (fap/semantics.md, section 10) and a tenth more.
TEST(ArkitFit, FacesOfOthersComeBack) {
  const auto clips = test::shared_dir() / "wild_fap";
  if (test::shared_dir().empty()) GTEST_SKIP() << "no reference data";
  for (const auto& [name, bound] :
       {std::pair{"xface_fear.fap", 0.21}, std::pair{"jag.fap", 0.33}}) {
    const auto clip = read_text(test::slurp(clips / name));
    ASSERT_TRUE(clip) << name;
    const auto filled = fill(*clip, {.complete = true});
    ASSERT_TRUE(filled);
    ArkitFitter fitter({.sparsity = 0});
    double error = 0;
    double power = 0;
    for (const Frame& frame : filled->frames)
      add_residual(frame, shown(fitter.fit(frame)), error, power);
    EXPECT_LT(std::sqrt(error / power), 1.1 * bound) << name;
  }
}

}  // namespace arkit_fit_test
}  // namespace animeme::fap
