// Sequences of ARKit's weights through FAPs: they come back in time, frame after frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <sstream>
#include <string>

#include "fap/arkit.h"
#include "fap/shape_fit.h"
#include "fap/viseme.h"
#include "tests/support/shared.h"

namespace animeme::fap {
namespace arkit_sequence_test {

using Sequence = std::vector<ArkitFrame>;
using Curve = std::map<std::string, double>;

std::size_t channel(std::string_view name) { return std::size_t(find_arkit(name).value_or(0)); }

ArkitFrame weights_of(const Curve& curve) {
  ArkitFrame frame{};
  for (const auto& [name, value] : curve) frame[channel(name)] = value;
  return frame;
}

Sequence fitted(const Sequence& given) {
  ArkitFitter fitter;
  Sequence out;
  for (const ArkitFrame& weights : given) {
    Frame frame = arkit_to_fap(weights, kAllArkit);
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (!frame.mask[std::size_t(fap)]) frame.set(fap, 0);  // as a stream that is complete
    }
    out.push_back(fitter.fit(frame));
  }
  return out;
}

struct Difference {
  double mean = 0;
  double frames_off = 0;  // share of those with a weight that is off by more than 0.2
};

Difference compare(const Sequence& given, const Sequence& found) {
  Difference difference;
  for (std::size_t i = 0; i < given.size(); ++i) {
    bool off = false;
    for (std::size_t c = 0; c < std::size_t(kArkitShapeCount); ++c) {
      const double one = std::abs(std::clamp(given[i][c], 0.0, 1.0) - found[i][c]);
      difference.mean += one / kArkitShapeCount / double(given.size());
      off = off || one > 0.2;
    }
    difference.frames_off += off ? 1.0 / double(given.size()) : 0;
  }
  return difference;
}

double bump(double t, double from, double length) {
  const double share = (t - from) / length;
  return share > 0 && share < 1 ? std::pow(std::sin(M_PI * share), 2) : 0;
}

// Blinks, winks, squints, wide eyes, gaze and a mouth that talks.
Sequence made(double rate) {
  Sequence sequence;
  for (int i = 0; i < int(8 * rate); ++i) {
    const double t = i / rate;
    double blink = 0;
    for (int k = 0; k < 6; ++k) blink = std::max(blink, bump(t, 0.4 + 1.3 * k, 0.25));
    const double wide = blink == 0 ? 0.6 * std::max(0.0, std::sin(0.9 * t + 2)) : 0;
    const double squint = 0.5 * std::max(0.0, std::sin(1.1 * t));
    const double across = 0.6 * std::sin(0.7 * t), up = 0.3 * std::sin(0.5 * t + 1);
    Curve curve{{"eyeBlinkLeft", 0.95 * blink},
                {"eyeBlinkRight", int(t) % 3 == 0 ? 0.1 * blink : blink},
                {"eyeSquintLeft", squint},
                {"eyeSquintRight", squint},
                {"eyeWideLeft", wide},
                {"eyeWideRight", wide},
                {across > 0 ? "eyeLookOutLeft" : "eyeLookInLeft", std::abs(across)},
                {across > 0 ? "eyeLookInRight" : "eyeLookOutRight", std::abs(across)},
                {up > 0 ? "eyeLookUpLeft" : "eyeLookDownLeft", std::abs(up)},
                {up > 0 ? "eyeLookUpRight" : "eyeLookDownRight", std::abs(up)},
                {"jawOpen", 0.3 + 0.3 * std::sin(12 * t)},
                {"mouthPucker", std::max(0.0, 0.6 * std::sin(5 * t))},
                {"mouthSmileLeft", 0.2},
                {"mouthSmileRight", 0.2}};
    sequence.push_back(weights_of(curve));
  }
  return sequence;
}

TEST(ArkitSequence, MadeSequencesComeBack) {
  for (const double rate : {25.0, 30.0, 60.0}) {
    const Sequence given = made(rate), found = fitted(given);
    const Difference difference = compare(given, found);
    EXPECT_LT(difference.mean, 0.005) << rate;
    EXPECT_LE(difference.frames_off, 0.011) << rate;
  }
}

// Whoever turns the head, or looks further to the side than the shapes go, has the same face.
TEST(ArkitSequence, TurnsOfTheHeadSayNothingOfTheFace) {
  ArkitFitter fitter;
  const Sequence given = made(30);
  Sequence found;
  for (std::size_t i = 0; i < given.size(); ++i) {
    Frame frame = arkit_to_fap(given[i], kAllArkit);
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (!frame.mask[std::size_t(fap)]) frame.set(fap, 0);
    }
    for (const int fap : {48, 49, 50}) frame.set(fap, int(20000 * std::sin(0.1 * double(i) + fap)));
    for (const int fap : {23, 24}) frame.value[std::size_t(fap)] *= 3;
    found.push_back(fitter.fit(frame));
    for (const char* gaze :
         {"eyeLookInLeft", "eyeLookOutLeft", "eyeLookInRight", "eyeLookOutRight"}) {
      found.back()[channel(gaze)] = std::clamp(given[i][channel(gaze)], 0.0, 1.0);
    }
  }
  const Difference difference = compare(given, found);
  EXPECT_LT(difference.mean, 0.01);
  EXPECT_LE(difference.frames_off, 0.02);
}

// A blink that comes and goes slowly does not jump where the lids meet.
TEST(ArkitSequence, SlowBlinksLookingDownDoNotJump) {
  Sequence given;
  for (int i = 0; i <= 200; ++i) {
    const double blink = 0.9 * bump(i, 0, 200);
    given.push_back(weights_of({{"eyeBlinkLeft", blink},
                                {"eyeBlinkRight", blink},
                                {"eyeLookDownLeft", 0.45},
                                {"eyeLookDownRight", 0.45},
                                {"eyeSquintLeft", 0.15},
                                {"eyeSquintRight", 0.15}}));
  }
  const Sequence found = fitted(given);
  for (std::size_t i = 1; i < found.size(); ++i) {
    const double step = found[i][channel("eyeBlinkLeft")] - found[i - 1][channel("eyeBlinkLeft")];
    EXPECT_LE(std::abs(step), 0.1) << i;
    EXPECT_LE(found[i][channel("eyeWideLeft")], 0.05) << i;
  }
  EXPECT_GE(found[100][channel("eyeBlinkLeft")], 0.84);
}

// Lips that go further forward than they are narrow are as round as if they could be stretched at
// the same time.
TEST(ArkitSequence, RoundLipsStayRoundWithoutStretching) {
  ArkitFitter fitter;
  double wanted = 0, rounded = 0;
  for (int i = 0; i < 50; ++i) {
    const double pucker = 0.3 + 0.005 * i;
    Frame frame = arkit_to_fap(weights_of({{"mouthPucker", pucker},
                                           {"mouthStretchLeft", 0.4 * pucker},
                                           {"mouthStretchRight", 0.4 * pucker},
                                           {"jawOpen", 0.1}}),
                               kAllArkit);
    std::mt19937 random{unsigned(i)};
    for (const std::size_t fap : {4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58, 12, 13}) {
      frame.value[fap] += int(random() % 100) - 50;
    }
    const ArkitFrame found = fitter.fit(frame);
    wanted += pucker;
    rounded += found[channel("mouthPucker")];
    EXPECT_LE(found[channel("mouthStretchLeft")], 0.05) << i;
  }
  EXPECT_NEAR(rounded / wanted, 1, 0.06);
}

// The eyes do not pop open after a blink.
TEST(ArkitSequence, NoWideEyesAfterBlinks) {
  for (const double rate : {25.0, 30.0, 60.0}) {
    Sequence given;
    for (int i = 0; i < int(4 * rate); ++i) {
      const double t = i / rate;
      const double blink = bump(t, 1, 0.3), squint = t > 1.3 ? 0.5 : 0;
      given.push_back(weights_of({{"eyeBlinkLeft", blink},
                                  {"eyeBlinkRight", blink},
                                  {"eyeSquintLeft", squint},
                                  {"eyeSquintRight", squint}}));
    }
    const Sequence found = fitted(given);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_LE(found[i][channel("eyeWideLeft")], 0.05) << rate << " frame " << i;
      EXPECT_LE(found[i][channel("eyeWideRight")], 0.05) << rate << " frame " << i;
      EXPECT_NEAR(found[i][channel("eyeBlinkLeft")], given[i][channel("eyeBlinkLeft")], 0.06);
    }
  }
}

// Lids alone: the blink is whole, and nothing else of the face moves.
TEST(ArkitSequence, LidsAloneAreABlink) {
  for (const auto& [upper, lower] : {std::pair{1024, 0}, {995, 29}, {512, 512}, {700, 324}}) {
    Frame closed;
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) closed.set(fap, 0);
    for (const int fap : {19, 20}) closed.set(fap, upper);
    for (const int fap : {21, 22}) closed.set(fap, lower);
    ArkitFitter fitter;
    const ArkitFrame found = fitter.fit(closed);
    for (std::size_t c = 0; c < std::size_t(kArkitShapeCount); ++c) {
      const std::string_view name = kArkitNames[c];
      if (name.starts_with("eyeSquint")) continue;
      if (name.starts_with("eyeBlink")) {
        EXPECT_GE(found[c], 0.99) << name << upper;
      } else {
        EXPECT_LE(found[c], 0.1) << name << " at " << upper;
      }
    }
  }
}

// Speech that no shapes made, with a blink: the mouth does not move the lids.
TEST(ArkitSequence, BlinksInSpeechOfOthers) {
  std::mt19937 random(5);
  ArkitFitter fitter;
  for (int i = 0; i < 120; ++i) {
    const double t = i / 60.0;
    Frame frame = arkit_to_fap(weights_of({{"jawOpen", 0.2 + 0.2 * std::sin(15 * t)},
                                           {"eyeBlinkLeft", bump(t, 1, 0.25)},
                                           {"eyeBlinkRight", bump(t, 1, 0.25)}}),
                               kAllArkit);
    for (const std::size_t fap : {4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58, 12, 13, 6, 7}) {
      frame.value[fap] += int(random() % 120) - 60;
    }
    const ArkitFrame found = fitter.fit(frame);
    EXPECT_LE(found[channel("eyeWideLeft")], 0.05) << i;
    EXPECT_NEAR(found[channel("eyeBlinkLeft")], bump(t, 1, 0.25), 0.1) << i;
  }
}

// Speech of a face that no shapes made: of two shapes that undo each other one is used.
TEST(ArkitSequence, OppositesAreNotTogether) {
  const std::pair<const char*, const char*> pairs[] = {{"mouthPucker", "mouthStretchLeft"},
                                                       {"mouthPucker", "mouthStretchRight"},
                                                       {"mouthFunnel", "mouthRollUpper"},
                                                       {"mouthFunnel", "mouthRollLower"},
                                                       {"mouthPressLeft", "mouthUpperUpLeft"},
                                                       {"mouthPressRight", "mouthUpperUpRight"},
                                                       {"mouthSmileLeft", "mouthFrownLeft"},
                                                       {"mouthSmileRight", "mouthFrownRight"},
                                                       {"mouthRollUpper", "mouthUpperUpLeft"},
                                                       {"mouthRollLower", "mouthLowerDownLeft"},
                                                       {"jawLeft", "jawRight"},
                                                       {"mouthLeft", "mouthRight"},
                                                       {"eyeBlinkLeft", "eyeWideLeft"},
                                                       {"eyeBlinkRight", "eyeWideRight"}};
  std::mt19937 random(11);
  ArkitFitter fitter;
  for (int i = 0; i < 200; ++i) {
    const double t = i / 25.0;
    Frame frame = arkit_to_fap(weights_of({{"jawOpen", 0.2 + 0.2 * std::sin(15 * t)},
                                           {"mouthPucker", std::max(0.0, 0.7 * std::sin(9 * t))}}),
                               kAllArkit);
    // Lips further forward than they are narrow, as recorded ones are, and not the same left and
    // right.
    for (const std::size_t fap : {16, 17}) frame.value[fap] += int(150 * std::sin(9 * t));
    for (const std::size_t fap : {4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58, 12, 13, 6, 7}) {
      frame.value[fap] += int(random() % 120) - 60;
    }
    const ArkitFrame found = fitter.fit(frame);
    for (const auto& [one, other] : pairs) {
      EXPECT_LE(std::min(found[channel(one)], found[channel(other)]), 0.05)
          << one << " and " << other << " in frame " << i;
    }
  }
}

// A face that shapes made and one that others made are the ends of a line: on the way from the one
// to the other, of two shapes that undo each other one goes without a jump.
TEST(ArkitSequence, OppositesGoAsOthersMakeTheFace) {
  const std::pair<const char*, const char*> pairs[] = {{"mouthPucker", "mouthStretchLeft"},
                                                       {"mouthFunnel", "mouthRollUpper"},
                                                       {"mouthPressLeft", "mouthUpperUpLeft"},
                                                       {"mouthLeft", "mouthRight"},
                                                       {"mouthRollLower", "mouthLowerDownLeft"}};
  for (const auto& [one, other] : pairs) {
    const ArkitFrame weights = weights_of({{one, 0.6}, {other, 0.4}, {"jawOpen", 0.3}});
    double last = 0.4;
    int between = 0;
    for (int units = 0; units < 60; ++units) {
      Frame frame = arkit_to_fap(weights, kAllArkit);
      int k = 0;
      for (const std::size_t fap : {4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58, 12, 13, 6, 7}) {
        frame.value[fap] += (k % 2 == 0 ? -1 : 1) * units * (1 + (k + 1) % 3) / 3;
        ++k;
      }
      const ArkitFrame found = ArkitFitter().fit(frame);
      const double less = std::min(found[channel(one)], found[channel(other)]);
      EXPECT_LE(std::abs(less - last), 0.2) << one << " and " << other << ", " << units;
      between += less > 0.06 && less < 0.3 ? 1 : 0;
      last = less;
    }
    EXPECT_GE(between, 2) << one << " and " << other;
    EXPECT_LT(last, 0.01) << one << " and " << other;
  }
}

// Nor are they on heads that visemes open, without ARKit's jaw.
TEST(ArkitSequence, OppositesAreNotTogetherWithoutAJaw) {
  const std::pair<const char*, const char*> pairs[] = {{"mouthLeft", "mouthRight"},
                                                       {"mouthSmileLeft", "mouthFrownLeft"},
                                                       {"mouthSmileRight", "mouthFrownRight"},
                                                       {"mouthPucker", "mouthStretchLeft"},
                                                       {"mouthPucker", "mouthStretchRight"}};
  std::vector<Frame> shapes;
  std::vector<std::optional<int>> channels;
  for (std::size_t c = channel("mouthClose"); c <= channel("mouthUpperUpRight"); ++c) {
    ArkitFrame one{};
    one[c] = 1;
    shapes.push_back(arkit_to_fap(one, kAllArkit));
    channels.emplace_back(int(c));
  }
  for (int viseme = 1; viseme < kVisemeCount; ++viseme) {
    shapes.push_back(viseme_shape(viseme));
    channels.emplace_back(std::nullopt);
  }
  ShapeFitter fitter(shapes, {}, 0.001, channels);
  const auto place = [&](const char* name) {
    return std::size_t(std::find(channels.begin(), channels.end(), int(channel(name))) -
                       channels.begin());
  };
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    Frame frame = arkit_to_fap(weights_of({{"jawOpen", 0.2 + 0.2 * std::sin(0.6 * i)},
                                           {"mouthPucker", std::abs(0.5 * std::sin(0.36 * i))}}),
                               kAllArkit);
    for (const std::size_t fap : {4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58, 12, 13, 6, 7}) {
      frame.value[fap] += int(random() % 160) - 80;
    }
    const std::vector<double>& found = fitter.fit(frame);
    for (const auto& [one, other] : pairs) {
      EXPECT_LE(std::min(found[place(one)], found[place(other)]), 0.05) << one << " " << i;
    }
  }
}

Sequence read_controls(const std::string& text) {
  std::istringstream lines(text);
  std::string line, cell;
  std::getline(lines, line);
  std::vector<std::optional<int>> channels;
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) {
    channels.push_back(find_arkit(cell));
  }
  Sequence out;
  while (std::getline(lines, line)) {
    out.emplace_back();
    std::size_t i = 0;
    for (std::istringstream cells(line); std::getline(cells, cell, ','); ++i) {
      if (i < channels.size() && channels[i]) {
        out.back()[std::size_t(*channels[i])] = std::atof(cell.c_str());
      }
    }
  }
  return out;
}

// Two takes of an iPhone, all of the face.
TEST(ArkitSequence, RecordedTakesComeBack) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "no reference data";
  const auto folder = test::shared_dir() / "data" / "livelink_rom" / "controls";
  for (const char* name : {"alex_rom_3.csv", "alex_rom_4.csv"}) {
    const Sequence given = read_controls(test::slurp(folder / name));
    ASSERT_GT(given.size(), 3000u) << name;
    const Difference difference = compare(given, fitted(given));
    EXPECT_LT(difference.mean, 0.01) << name;
    EXPECT_LE(difference.frames_off, 0.01) << name;
  }
}

}  // namespace arkit_sequence_test
}  // namespace animeme::fap
