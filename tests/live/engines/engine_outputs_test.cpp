// What engines are sent, as an independent reader sees it: values, times, rates, ten minutes long.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <ctime>
#include <map>
#include <set>

#include "tests/live/engines/engines_support.h"

namespace animeme {
namespace engine_outputs_test {

using test::face_at;
using test::fit_of;
using test::Json;
using test::moving_face;
using test::MovingFace;
using test::read_by_others;
using test::sent_to;
using testing::HasSubstr;

class EngineOutputs : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_program("python3")) GTEST_SKIP() << "python3 is not installed";
  }
};

// Made once.
const MovingFace& ten_minutes() {
  static const MovingFace face = moving_face(600, {15, 1});
  return face;
}

const std::vector<fap::ArkitFrame>& fit_of_ten_minutes() {
  static const auto fit = fit_of(ten_minutes());
  return fit;
}

constexpr double kFloat = 2e-6;  // what 32 bits leave of a weight or an angle

// The fit at a time between planes: on the straight line, as the receivers of engines would.
fap::ArkitFrame fit_at(const std::vector<fap::ArkitFrame>& fit, double rate, double seconds) {
  const double place = seconds * rate;
  const auto before = std::size_t(std::min(std::floor(place + 1e-6), double(fit.size() - 1)));
  const std::size_t after = std::min(before + 1, fit.size() - 1);
  fap::ArkitFrame out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] =
        fit[before][i] + (fit[after][i] - fit[before][i]) * std::max(0.0, place - double(before));
  }
  return out;
}

// How far values are off at most; 1 if there are not `count` of them, those of ARKit.
double worst_of(const Json& values, const fap::ArkitFrame& want, std::size_t count) {
  if (values.size() != count) return 1;
  double worst = 0;
  for (const auto& [name, value] : values.items()) {
    const auto channel = fap::find_arkit(name);
    if (!channel || name != test::capital(fap::kArkitNames[std::size_t(*channel)])) return 1;
    worst = std::max(worst, std::abs(value.get<double>() - want[std::size_t(*channel)]));
  }
  return worst;
}

void expect_times(const std::vector<Json>& frames, double rate, double seconds) {
  ASSERT_EQ(frames.size(), std::size_t(std::llround(rate * seconds)));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_NEAR(double(frames[i]["at"]), double(i) / rate, 1e-6) << i;
  }
}

void expect_live_link(const MovingFace& face, const std::vector<fap::ArkitFrame>& fit,
                      const std::string& query, double rate, double seconds) {
  const auto frames =
      read_by_others("livelink", sent_to("livelink://192.0.2.1:11111" + query, face));
  expect_times(frames, rate, seconds);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Json& frame = frames[i];
    ASSERT_NEAR(double(frame["time"]), double(i) / rate, 1e-3 / rate) << i;
    ASSERT_NEAR(double(frame["rate"]), rate, 1e-9);
    const fap::ArkitFrame want = fit_at(fit, face.rate.frames_per_second(), double(i) / rate);
    ASSERT_LT(worst_of(frame["values"], want, want.size()), kFloat) << i;
  }
}

TEST_F(EngineOutputs, TenMinutesOfLiveLinkAreTheFit) {
  expect_live_link(ten_minutes(), fit_of_ten_minutes(), "", 15, 600);
}

TEST_F(EngineOutputs, LiveLinkKeepsAnyRate) {
  const MovingFace face = moving_face(20);
  const auto fit = fit_of(face);
  for (const int rate : {15, 24, 30, 60, 120}) {
    expect_live_link(face, fit, "?rate=" + std::to_string(rate), rate, 20);
  }
  const MovingFace ntsc = moving_face(20, {30000, 1001});
  expect_live_link(ntsc, fit_of(ntsc), "", 30000.0 / 1001, 20);
}

TEST_F(EngineOutputs, LiveLinkHasItsNameAndItsDevice) {
  const MovingFace face = moving_face(0.2);
  const auto plain = sent_to("livelink://192.0.2.1", face);
  const auto phone = sent_to("livelink://192.0.2.1?subject=iPhone", face);
  const auto anna = sent_to("livelink://192.0.2.1?subject=Anna%20B&rate=60", face);
  ASSERT_EQ(phone.front().bytes.size(), 312u);  // all that VRCFaceTracking takes
  ASSERT_EQ(plain.front().bytes.size(), 312u);
  EXPECT_EQ(read_by_others("livelink", plain)[0]["subject"], "Avatar");
  EXPECT_EQ(read_by_others("livelink", anna)[0]["subject"], "Anna B");
  EXPECT_NE(read_by_others("livelink", anna)[0]["device"],
            read_by_others("livelink", phone)[0]["device"]);
}

TEST_F(EngineOutputs, LiveLinkCountsFromMidnightIfAsked) {
  const MovingFace face = moving_face(1);
  const auto seconds_now = [] {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    return 3600.0 * local.tm_hour + 60.0 * local.tm_min + local.tm_sec;
  };
  const double before = seconds_now();
  const auto day =
      read_by_others("livelink", sent_to("livelink://192.0.2.1?rate=60&timecode=day", face));
  const double after = seconds_now();
  const auto stream =
      read_by_others("livelink", sent_to("livelink://192.0.2.1?rate=60&timecode=stream", face));
  ASSERT_EQ(day.size(), stream.size());
  const double first = day[0]["time"].get<double>();
  if (after >= before) {  // not at midnight
    EXPECT_GE(first, before - 1);
    EXPECT_LE(first, after + 2);
  }
  EXPECT_LT(stream[0]["time"].get<double>(), 1);
  for (std::size_t i = 1; i < day.size(); ++i) {
    const double step = day[i]["time"].get<double>() - day[i - 1]["time"].get<double>();
    if (step < 0) continue;  // midnight
    EXPECT_NEAR(step, 1 / 60.0, 0.001);
  }
}

// A turn by a quaternion, multiplied out from three turns about axes.
using Four = std::array<double, 4>;  // x y z w
Four times(const Four& a, const Four& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}
Four turn(std::size_t axis, double angle) {
  Four out{0, 0, 0, std::cos(angle / 2)};
  out[axis] = std::sin(angle / 2);
  return out;
}

TEST_F(EngineOutputs, TenMinutesOfVmcAreTheFit) {
  const MovingFace& face = ten_minutes();
  auto frames = read_by_others("vmc", sent_to("vmc://192.0.2.1", face));
  ASSERT_TRUE(frames.back().contains("end"));
  frames.pop_back();
  expect_times(frames, 15, 600);
  const auto& fit = fit_of_ten_minutes();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const fap::ArkitFrame want = fit_at(fit, 15, double(i) / 15);
    ASSERT_NEAR(double(frames[i]["time"]), double(i) / 15, 1e-4);
    ASSERT_LT(worst_of(frames[i]["values"], want, fap::kArkitShapeCount), kFloat) << i;
    std::size_t channel = 52;
    for (const char* bone : {"Head", "LeftEye", "RightEye"}) {
      // Unity: yaw about y, then pitch about x, then roll about z.
      const Four q = times(times(turn(1, want[channel]), turn(0, want[channel + 1])),
                           turn(2, want[channel + 2]));
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(double(frames[i]["bones"][bone][k]), 0);
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_NEAR(double(frames[i]["bones"][bone][3 + k]), q[k], kFloat) << bone << k;
      }
      channel += 3;
    }
  }
}

TEST_F(EngineOutputs, VmcHasTheNamesOfVrmIfAskedFor) {
  const MovingFace face = moving_face(4);
  const auto fit = fit_of(face);
  const auto old = read_by_others("vmc", sent_to("vmc://192.0.2.1?names=vrm0&bones=off", face));
  const auto young = read_by_others("vmc", sent_to("vmc://192.0.2.1?names=vrm1", face));
  ASSERT_EQ(old.size(), 101u);
  ASSERT_EQ(young.size(), 101u);
  double widest = 0, least = 1;
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(old[i]["values"].size(), 12u);
    EXPECT_TRUE(old[i]["bones"].empty());
    EXPECT_EQ(young[i]["bones"].size(), 3u);
    for (const auto& [zero, one] : std::map<std::string, std::string>{{"A", "aa"},
                                                                      {"I", "ih"},
                                                                      {"U", "ou"},
                                                                      {"E", "ee"},
                                                                      {"O", "oh"},
                                                                      {"Blink_L", "blinkLeft"},
                                                                      {"Joy", "happy"}}) {
      const double value = old[i]["values"][zero];
      EXPECT_EQ(value, double(young[i]["values"][one]));
      EXPECT_TRUE(value >= 0 && value <= 1);
    }
    EXPECT_NEAR(double(old[i]["values"]["Blink_L"]), fit[i][0], kFloat);
    // Wide where the jaw is open, little where it is not.
    double vowels = 0;
    for (const char* name : {"A", "I", "U", "E", "O"}) vowels += double(old[i]["values"][name]);
    widest = std::max(widest, vowels);
    least = std::min(least, vowels);
  }
  EXPECT_GT(widest, 0.6);
  EXPECT_LE(widest, 1 + kFloat);  // the jaw opens half way
  EXPECT_LT(least, 0.3);
}

// Some of the table, worked out by hand from UnifiedExpressionsParameters.cs.
std::map<std::string, double> unified_of(const fap::ArkitFrame& face) {
  const auto at = [&](const char* name) { return face[std::size_t(*fap::find_arkit(name))]; };
  return {{"v2/JawOpen", at("jawOpen")},
          {"v2/JawX", at("jawRight") - at("jawLeft")},
          {"v2/MouthX", at("mouthRight") - at("mouthLeft")},
          {"v2/LipPuckerUpperRight", at("mouthPucker")},
          {"v2/MouthCornerPullLeft", at("mouthSmileLeft")},
          {"v2/SmileFrownRight", at("mouthSmileRight") - at("mouthFrownRight")},
          {"v2/BrowInnerUpLeft", at("browInnerUp")},
          {"v2/EyeLidLeft", 0.75 * (1 - at("eyeBlinkLeft")) + 0.25 * at("eyeWideLeft")},
          {"v2/EyeLeftX", at("eyeLookInLeft") - at("eyeLookOutLeft")},
          {"v2/EyeRightX", at("eyeLookOutRight") - at("eyeLookInRight")},
          {"EyesClosedAmount", (at("eyeBlinkLeft") + at("eyeBlinkRight")) / 2}};
}

TEST_F(EngineOutputs, TenMinutesOfUnifiedExpressionsAreTheFit) {
  const MovingFace& face = ten_minutes();
  const auto frames = read_by_others("osc", sent_to("osc://192.0.2.1", face));
  expect_times(frames, 15, 600);
  const auto& fit = fit_of_ten_minutes();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const fap::ArkitFrame want = fit_at(fit, 15, double(i) / 15);
    for (const auto& [name, value] : unified_of(want)) {
      ASSERT_NEAR(double(frames[i]["values"][name]), value, kFloat) << name << " " << i;
    }
    const Json& gaze = frames[i]["values"]["LeftRightPitchYaw"];
    const std::array<std::size_t, 4> channels{56, 55, 59, 58};
    for (std::size_t k = 0; k < 4; ++k) {
      ASSERT_NEAR(double(gaze[k]), want[channels[k]] * 180 / std::numbers::pi, 1e-4);
    }
  }
}

TEST_F(EngineOutputs, ParametersMayHaveAPrefixOfTheirAvatar) {
  const auto frames =
      read_by_others("osc", sent_to("osc://192.0.2.1?prefix=FT/v2", moving_face(0.2)));
  EXPECT_TRUE(frames[0]["values"].contains("FT/v2/JawOpen"));
  EXPECT_FALSE(frames[0]["values"].contains("v2/JawOpen"));
  EXPECT_TRUE(frames[0]["values"].contains("LeftRightPitchYaw"));
  const auto blind = read_by_others("osc", sent_to("osc://192.0.2.1?gaze=off", moving_face(0.2)));
  EXPECT_TRUE(blind[0]["values"].contains("v2/EyeLeftX"));
  EXPECT_FALSE(blind[0]["values"].contains("LeftRightPitchYaw"));
  EXPECT_FALSE(blind[0]["values"].contains("EyesClosedAmount"));
}

TEST_F(EngineOutputs, AvatarsWithoutRoomForFloatsGetBits) {
  const MovingFace face = moving_face(4);
  const auto frames = read_by_others("osc", sent_to("osc://192.0.2.1?binary=3", face));
  std::map<std::string, double> now;
  std::set<int> seen;
  bool left = false, right = false;
  for (const auto& frame : frames) {
    for (const auto& [name, value] : frame["values"].items()) {
      if (value.is_number() || value.is_boolean()) {
        now[name] = value.is_boolean() ? double(bool(value)) : double(value);
      }
    }
    for (const char* name : {"v2/JawOpen", "v2/MouthX", "v2/EyeLeftX", "v2/LipPuckerUpperLeft"}) {
      const std::string begin = name;
      const double value = now.at(begin);
      const int number =
          int(now.at(begin + "1") + 2 * now.at(begin + "2") + 4 * now.at(begin + "4"));
      const double exact = std::abs(value) > 0.99999 ? 7 : std::abs(value) * 7;
      ASSERT_GE(exact, number - 1e-4) << name;
      ASSERT_LT(exact, number + 1 + 1e-4) << name;
      if (begin == "v2/JawOpen") seen.insert(number);
    }
    ASSERT_EQ(now.at("v2/EyeLeftXNegative") != 0, now.at("v2/EyeLeftX") < 0);
    (now.at("v2/EyeLeftX") < 0 ? left : right) = true;
  }
  EXPECT_GT(seen.size(), 3u);
  EXPECT_TRUE(left && right);
  EXPECT_FALSE(now.contains("v2/JawOpenNegative")) << "it cannot be";
  EXPECT_FALSE(now.contains("v2/JawOpen8"));
  EXPECT_FALSE(now.contains("v2/Head/Yaw1"));
  const auto plain = read_by_others("osc", sent_to("osc://192.0.2.1", moving_face(0.2)));
  EXPECT_FALSE(plain[0]["values"].contains("v2/JawOpen1"));
}

TEST_F(EngineOutputs, WhatDoesNotChangeIsSentOnceASecond) {
  MovingFace face = moving_face(3);
  const auto sent = sent_to("osc://192.0.2.1", face);
  std::map<std::string, int> count;
  for (const test::Sent& each : sent) {
    const std::string bytes(each.bytes.begin(), each.bytes.end());
    for (const char* name : {"/v2/TongueOut", "/v2/JawOpen"}) {
      count[name] += bytes.find(name) != std::string::npos;
    }
  }
  EXPECT_EQ(count["/v2/TongueOut"], 3);
  EXPECT_GT(count["/v2/JawOpen"], 70);
}

TEST_F(EngineOutputs, APlaneThatLastsIsSentAgain) {
  MovingFace face = moving_face(2);
  face.units.erase(face.units.begin() + 1, face.units.end());
  face.units[0].duration *= 25;  // a second
  const auto plain = read_by_others("livelink", sent_to("livelink://192.0.2.1", face));
  expect_times(plain, 25, 1);
  const auto fast = read_by_others("livelink", sent_to("livelink://192.0.2.1?rate=60", face));
  expect_times(fast, 60, 1);
  EXPECT_EQ(fast.front()["values"], fast.back()["values"]);
}

TEST_F(EngineOutputs, AddressesThatAreWrongSayWhatThereIs) {
  const auto message = [](const std::string& url) {
    const auto sink = engines::make_engine_sink(url);
    EXPECT_FALSE(sink) << url;
    if (sink) return std::string();
    EXPECT_EQ(sink.error().code, Code::invalid_argument);
    return sink.error().message;
  };
  EXPECT_THAT(message("livelink://h:1?names=arkit"), HasSubstr("rate=15..120, subject=NAME"));
  EXPECT_THAT(message("vmc://h?rat=60"), HasSubstr("names=arkit|vrm0|vrm1"));
  EXPECT_THAT(message("vmc://h?rate=14"), HasSubstr("from 15 to 120"));
  EXPECT_THAT(message("vmc://h?rate=121"), HasSubstr("from 15 to 120"));
  EXPECT_THAT(message("vmc://h?rate="), HasSubstr("from 15 to 120"));
  EXPECT_THAT(message("vmc://h?names=vrm2"), HasSubstr("arkit, vrm0 or vrm1"));
  EXPECT_THAT(message("vmc://h?bones=yes"), HasSubstr("on or off"));
  EXPECT_THAT(message("osc://h?gaze=1"), HasSubstr("on or off"));
  EXPECT_THAT(message("osc://h?prefix="), HasSubstr("1 to 64"));
  for (const char* wrong : {"0", "9", "", "12", "x"}) {
    EXPECT_THAT(message(std::string("osc://h?binary=") + wrong), HasSubstr("1 to 8"));
  }
  EXPECT_THAT(message("osc://:9000"), HasSubstr("name the machine"));
  EXPECT_THAT(message("osc://h:0"), HasSubstr("port 0"));
  EXPECT_THAT(message("osc://h:70000"), HasSubstr("scheme://host:port"));
  EXPECT_FALSE(engines::make_engine_source("vmc://:1?bones=on"));
}

TEST_F(EngineOutputs, SoundAloneIsNothingForEngines) {
  auto sink = engines::make_engine_sink("livelink://127.0.0.1:9", {.fast = true});
  ASSERT_TRUE(sink);
  media::LiveInfo info;
  info.audio.emplace();
  EXPECT_FALSE((*sink)->start(info));
}

}  // namespace engine_outputs_test
}  // namespace animeme
