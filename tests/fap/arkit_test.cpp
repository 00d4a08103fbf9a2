#include "fap/arkit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "fap/tables.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace arkit_test {

std::size_t channel(std::string_view name) {
  const std::optional<int> found = find_arkit(name);
  EXPECT_TRUE(found) << name;
  return std::size_t(found.value_or(0));
}

ArkitFrame weights(std::initializer_list<std::pair<std::string_view, double>> values) {
  ArkitFrame frame{};
  for (const auto& [name, value] : values) frame[channel(name)] = value;
  return frame;
}

Frame shown(std::initializer_list<std::pair<std::string_view, double>> values) {
  return arkit_to_fap(weights(values), kAllArkit);
}

ArkitChannels channels(std::initializer_list<std::string_view> names) {
  ArkitChannels set;
  for (const std::string_view name : names) set.set(channel(name));
  return set;
}

TEST(Arkit, NamesAreFoundInAnySpelling) {
  std::set<std::string_view> all(kArkitNames.begin(), kArkitNames.end());
  EXPECT_EQ(all.size(), std::size_t(kArkitChannelCount));
  for (std::size_t i = 0; i < kArkitNames.size(); ++i) {
    EXPECT_EQ(find_arkit(kArkitNames[i]), int(i));
    std::string pascal(kArkitNames[i]);
    pascal[0] = char(pascal[0] - 'a' + 'A');
    EXPECT_EQ(find_arkit(pascal), int(i));
  }
  EXPECT_EQ(find_arkit("eyeBlink_L"), find_arkit("eyeBlinkLeft"));
  EXPECT_EQ(find_arkit("MOUTHSMILE_R"), find_arkit("mouthSmileRight"));
  EXPECT_EQ(find_arkit("jaw_open "), find_arkit("jawOpen"));
  EXPECT_EQ(find_arkit("tongueOut"), kArkitShapeCount - 1);
  EXPECT_EQ(find_arkit("headYaw"), kArkitShapeCount);
  for (const char* name : {"head_lod0_mesh__jawOpen", "blendShapes.JawOpen", "mesh|jawOpen"}) {
    EXPECT_EQ(find_arkit(name), find_arkit("jawOpen")) << name;
  }
  for (const char* name : {"", "_L", "jaw", "openJaw", "eyeBlink", "cheekRaiserLeft"}) {
    EXPECT_FALSE(find_arkit(name)) << name;
  }
}

TEST(Arkit, AFaceAtRestIsNeutral) {
  const Frame frame = shown({});
  for (const std::int32_t value : frame.value) EXPECT_EQ(value, 0);
  EXPECT_EQ(frame.mask.count(), 54u);
  for (const std::size_t fap : {1, 2, 27, 30, 43, 46, 65, 68}) EXPECT_FALSE(frame.mask[fap]) << fap;
}

TEST(Arkit, TheMaskIsWhatTheChannelsReach) {
  EXPECT_EQ(arkit_faps({}), Mask());
  Mask lids;
  lids.set(19).set(21);
  EXPECT_EQ(arkit_faps(channels({"eyeBlinkLeft"})), lids);
  Mask roll;
  roll.set(50);
  EXPECT_EQ(arkit_faps(channels({"headRoll"})), roll);
  EXPECT_EQ(arkit_faps(channels({"leftEyeRoll"})), Mask());
  // Channels that are not there do not count, whatever the frame holds.
  const Frame frame =
      arkit_to_fap(weights({{"jawOpen", 1}, {"eyeBlinkLeft", 0.5}}), channels({"eyeBlinkLeft"}));
  EXPECT_EQ(frame.mask, lids);
  EXPECT_EQ(frame.value[3], 0);
}

TEST(Arkit, EveryShapeDoesSomething) {
  for (int i = 0; i < kArkitShapeCount; ++i) {
    ArkitFrame frame{};
    frame[std::size_t(i)] = 1;
    const Frame out = arkit_to_fap(frame, kAllArkit);
    bool moves = false;
    for (const std::int32_t value : out.value) moves = moves || std::abs(value) >= 20;
    EXPECT_TRUE(moves) << kArkitNames[std::size_t(i)];
  }
}

// The direction of each motion, from the names of shapes and FAPs alone.
TEST(Arkit, Signs) {
  const struct {
    const char* shape;
    int fap;
    int sign;
  } cases[] = {
      {"jawOpen", 3, 1},           {"jawOpen", 5, -1},
      {"jawForward", 14, 1},       {"jawLeft", 15, -1},
      {"jawRight", 15, 1},         {"mouthSmileLeft", 12, 1},
      {"mouthSmileLeft", 6, 1},    {"mouthSmileRight", 60, 1},
      {"mouthFrownRight", 13, -1}, {"mouthPucker", 16, 1},
      {"mouthPucker", 6, -1},      {"mouthFunnel", 4, -1},
      {"mouthUpperUpLeft", 8, -1}, {"mouthLowerDownRight", 11, -1},
      {"mouthRollLower", 16, -1},  {"browInnerUp", 31, 1},
      {"browDownLeft", 33, -1},    {"browOuterUpRight", 36, 1},
      {"cheekPuff", 39, 1},        {"cheekSquintRight", 42, 1},
      {"noseSneerLeft", 55, -1},   {"eyeBlinkLeft", 19, 1},
      {"eyeWideRight", 20, -1},    {"eyeSquintLeft", 21, 1},
      {"eyeLookInLeft", 23, -1},   {"eyeLookOutLeft", 23, 1},
      {"eyeLookInRight", 24, 1},   {"eyeLookOutRight", 24, -1},
      {"eyeLookDownLeft", 25, 1},  {"eyeLookUpRight", 26, -1},
      {"tongueOut", 45, 1},        {"headYaw", 49, -1},
      {"headPitch", 48, 1},        {"headRoll", 50, -1},
      {"mouthLeft", 53, 1},        {"mouthRight", 64, 1},
  };
  for (const auto& one : cases) {
    EXPECT_GT(one.sign * shown({{one.shape, 1}}).value[std::size_t(one.fap)], 0)
        << one.shape << " FAP " << one.fap;
  }
}

// Left and right of a face exchanged.
Frame mirror_of(const Frame& frame) {
  Frame out;
  for (const FapInfo& fap : kFaps) {
    if (!frame.mask[std::size_t(fap.number)]) continue;
    const int partner = fap.mirror ? fap.mirror : fap.number;
    const bool world = fap.number == 15 || fap.number == 23 || fap.number == 24 ||
                       fap.number == 49 || fap.number == 50 || fap.number == 64;
    out.set(partner, (world ? -1 : 1) * frame.value[std::size_t(fap.number)]);
  }
  return out;
}

TEST(Arkit, TheSidesMirrorEachOther) {
  int pairs = 0;
  for (const std::string_view name : kArkitNames) {
    if (!name.ends_with("Left")) continue;
    const std::string right = std::string(name.substr(0, name.size() - 4)) + "Right";
    EXPECT_EQ(mirror_of(shown({{name, 1}})), shown({{right, 1}})) << name;
    ++pairs;
  }
  EXPECT_EQ(pairs, 20);
  for (const char* name : {"jawOpen", "mouthClose", "mouthPucker", "mouthFunnel", "browInnerUp",
                           "cheekPuff", "mouthShrugUpper", "mouthRollLower", "headPitch"}) {
    EXPECT_EQ(mirror_of(shown({{name, 1}})), shown({{name, 1}})) << name;
  }
  EXPECT_EQ(mirror_of(shown({{"headYaw", 0.3}})), shown({{"headYaw", -0.3}}));
}

TEST(Arkit, MeasuredValues) {
  const Frame open = shown({{"jawOpen", 1}});
  EXPECT_EQ(open.value[3], 1360);
  EXPECT_EQ(open.value[5], -1700);
  EXPECT_EQ(open.value[12], -732);
  const Frame half = shown({{"jawOpen", 0.5}, {"mouthClose", 0.25}});
  EXPECT_EQ(half.value[3], std::lround(0.5 * 1360 - 0.25 * 189));
  EXPECT_EQ(half.value[5], std::lround(-0.5 * 1700 + 0.25 * 1844));
  // The two sides of the model's shape are summed.
  EXPECT_EQ(shown({{"browInnerUp", 1}}).value[31], 95 + 23);
}

TEST(Arkit, LidsMeetAndDoNotPass) {
  const Frame blink = shown({{"eyeBlinkLeft", 1}});
  EXPECT_EQ(blink.value[19] + blink.value[21], 1024);
  EXPECT_EQ(blink.value[20], 0);
  const Frame pressed = shown({{"eyeBlinkLeft", 1},
                               {"eyeLookDownLeft", 0.6},
                               {"eyeSquintLeft", 1},
                               {"eyeBlinkRight", 0.9},
                               {"eyeSquintRight", 1}});
  EXPECT_EQ(pressed.value[19] + pressed.value[21], 1024);
  EXPECT_EQ(pressed.value[20] + pressed.value[22], 1024);
  const Frame open = shown({{"eyeBlinkLeft", 0.5}, {"eyeLookDownLeft", 0.2}});
  EXPECT_EQ(open.value[19], std::lround(0.5 * 995 + 0.2 * 667));
}

TEST(Arkit, GazeComesFromShapesElseFromAngles) {
  const ArkitFrame both = weights(
      {{"eyeLookInLeft", 0.5}, {"leftEyeYaw", 0.1}, {"rightEyeYaw", 0.2}, {"rightEyePitch", 0.3}});
  const Frame shapes = arkit_to_fap(both, kAllArkit);
  EXPECT_EQ(shapes.value[23], -30544);  // half of 35 degrees to the right
  EXPECT_EQ(shapes.value[24], 0);
  const Frame angles =
      arkit_to_fap(both, channels({"leftEyeYaw", "rightEyeYaw", "rightEyePitch", "eyeBlinkLeft"}));
  EXPECT_EQ(angles.value[23], -10000);
  EXPECT_EQ(angles.value[24], -20000);
  EXPECT_EQ(angles.value[26], 30000);
  EXPECT_FALSE(angles.mask[25]);
  // By axis: no shape says how high the left eye looks.
  const Frame mixed = arkit_to_fap(weights({{"leftEyeYaw", 0.1}, {"leftEyePitch", 0.1}}),
                                   channels({"eyeLookInLeft", "leftEyeYaw", "leftEyePitch"}));
  EXPECT_EQ(mixed.value[23], 0);
  EXPECT_EQ(mixed.value[25], 10000);
}

TEST(Arkit, HeadAnglesAreHundredThousandthsOfARadian) {
  const Frame frame = shown({{"headYaw", 0.25}, {"headPitch", -0.5}, {"headRoll", 0.125}});
  EXPECT_EQ(frame.value[49], -25000);
  EXPECT_EQ(frame.value[48], -50000);
  EXPECT_EQ(frame.value[50], -12500);
}

TEST(Arkit, AnyNumberIsSafeAndCodable) {
  made::Random random(3);
  const double odd[] = {0,
                        1,
                        -1,
                        1e9,
                        -1e300,
                        1e308,
                        std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::quiet_NaN()};
  for (int round = 0; round < 200; ++round) {
    ArkitFrame frame;
    for (double& value : frame) value = odd[random.in(0, 7)];
    const Frame out = arkit_to_fap(frame, kAllArkit);
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      EXPECT_LE(std::abs(out.value[std::size_t(fap)]), 1860 * info(fap).quant_step) << fap;
    }
    EXPECT_LE(out.value[19] + out.value[21], 1024);
  }
  EXPECT_EQ(shown({{"jawOpen", std::nan("")}}), shown({}));
}

// Angles of the eyeballs give way to shapes of the gaze, in each of the four FAPs.
TEST(Arkit, ShapesOfTheGazeCountMoreThanAngles) {
  const ArkitFrame looks = weights({{"eyeLookDownLeft", 0.5},
                                    {"eyeLookDownRight", 0.5},
                                    {"eyeLookInLeft", 0.5},
                                    {"eyeLookOutRight", 0.5}});
  ArkitFrame both = looks;
  for (const char* angle : {"leftEyeYaw", "leftEyePitch", "rightEyeYaw", "rightEyePitch"}) {
    both[channel(angle)] = 0.3;
  }
  const Frame alone = arkit_to_fap(looks, kAllArkit), with_angles = arkit_to_fap(both, kAllArkit);
  for (const std::size_t fap : {23, 24, 25, 26}) {
    EXPECT_NE(alone.value[fap], 0) << fap;
    EXPECT_EQ(with_angles.value[fap], alone.value[fap]) << fap;
  }
}

}  // namespace arkit_test
}  // namespace animeme::fap
