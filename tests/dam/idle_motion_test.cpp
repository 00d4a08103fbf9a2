#include "dam/speaking/idle_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace idle_motion_test {

constexpr double kDegree = 1745.329;  // in units of FAP angles

Signal mouth(std::size_t frames, std::vector<std::string> names = {"fap3_open_jaw"},
             std::uint32_t rate = 50) {
  Signal signal;
  signal.rate = {rate, 1};
  signal.names = std::move(names);
  signal.values.assign(frames * signal.names.size(), 7.0);
  return signal;
}

/// Two phrases with a pause from 2 to 3 s; the AY from 1.0 to 1.3 s is drawn out.
Script phrases() {
  return {{{0, 0.5, "SIL", ""},
           {0.5, 0.6, "AE", "at"},
           {0.6, 1.0, "T", "at"},
           {1.0, 1.3, "AY", "eye"},
           {1.3, 2.0, "T", "eye"},
           {2.0, 3.0, "SIL", ""},
           {3.0, 3.1, "AE", "at"},
           {3.1, 3.5, "T", "at"},
           {3.5, 20.0, "SIL", ""}}};
}

/// Sentences of five words, one in four a question, with pauses.
Script talk(double seconds) {
  Script script;
  double at = 0;
  int word = 0;
  const auto add = [&](double length, const char* label, const std::string& text) {
    script.phones.push_back({at, at + length, label, text});
    at += length;
  };
  while (at < seconds) {
    const bool last = word % 5 == 4;
    const std::string text = last ? (word % 20 == 4 ? "so?" : "so.") : "word";
    add(0.07, "T", text);
    add(0.08 + 0.05 * double(word * 7 % 4), word % 3 == 0 ? "AY" : "EH", text);
    add(0.06, "S", text);
    if (last) add(0.3 + 0.2 * double(word % 4), "SIL", "");
    ++word;
  }
  return script;
}

std::size_t channel(const Signal& signal, int fap) {
  for (std::size_t c = 0; c < signal.names.size(); ++c)
    if (fap_of_channel(signal.names[c]) == fap) return c;
  ADD_FAILURE() << "no FAP " << fap;
  return 0;
}

std::vector<double> curve(const Signal& signal, int fap) {
  std::vector<double> values;
  const std::size_t c = channel(signal, fap);
  for (std::size_t i = 0; i < signal.frames(); ++i) values.push_back(signal.at(i, c));
  return values;
}

double deviation(const std::vector<double>& values) {
  double mean = 0, sum = 0;
  for (const double v : values) mean += v / double(values.size());
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / double(values.size()));
}

Signal moved(const IdleMotionOptions& options, double seconds = 60, std::uint32_t rate = 50) {
  Signal signal = mouth(std::size_t(seconds * rate), {"fap3_open_jaw"}, rate);
  const auto report = add_idle_motion(signal, talk(seconds - 2), options);
  EXPECT_TRUE(report) << report.error().describe();
  return signal;
}

/// Frames at which the lids meet, those in a row once.
std::vector<std::size_t> closures(const Signal& signal) {
  const auto upper = curve(signal, 19), lower = curve(signal, 21);
  std::vector<std::size_t> frames;
  bool shut = false;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    const bool now = upper[i] + lower[i] > 1023.5;
    if (now && !shut) frames.push_back(i);
    shut = now;
    EXPECT_LT(upper[i] + lower[i], 1024.5);
  }
  return frames;
}

TEST(IdleMotion, LidsMeetAtAnyRate) {
  for (const std::uint32_t rate : {24u, 25u, 30u, 50u, 60u}) {
    Signal signal = mouth(60 * rate, {"fap3_open_jaw"}, rate);
    const auto report = add_idle_motion(signal, talk(58));
    ASSERT_TRUE(report) << report.error().describe();
    const std::size_t full = closures(signal).size();
    EXPECT_GE(full, 12u) << rate;
    EXPECT_LE(full, report->blinks) << rate;
    EXPECT_GE(double(full), 0.6 * double(report->blinks)) << "some are half";
    EXPECT_LE(report->blinks, 45u) << rate;
  }
}

TEST(IdleMotion, SeedsDifferAndRepeat) {
  EXPECT_EQ(moved({1, 3}).values, moved({1, 3}).values);
  // Blinks of two seeds coincide no more often than those of two strangers.
  std::vector<std::set<std::size_t>> blinks;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto frames = closures(moved({1, seed}));
    blinks.emplace_back(frames.begin(), frames.end());
  }
  std::size_t shared = 0, pairs = 0;
  for (std::size_t a = 0; a < blinks.size(); ++a) {
    for (std::size_t b = a + 1; b < blinks.size(); ++b) {
      ++pairs;
      for (const std::size_t frame : blinks[a]) shared += blinks[b].count(frame);
    }
  }
  EXPECT_LE(double(shared) / double(pairs), 1.5) << "in a minute with some 20 blinks";
}

TEST(IdleMotion, TheMouthIsNotTouched) {
  Signal signal = mouth(500, {});
  for (int fap = 3; fap <= 18; ++fap) signal.names.push_back(fap_channel(fap));
  for (int fap = 51; fap <= 60; ++fap) signal.names.push_back(fap_channel(fap));
  for (std::size_t i = 0; i < 500 * signal.names.size(); ++i)
    signal.values.push_back(std::sin(0.37 * double(i)) * 300);
  const Signal before = signal;
  ASSERT_TRUE(add_idle_motion(signal, talk(9), {2, 5}));
  ASSERT_GT(signal.names.size(), before.names.size());
  for (std::size_t c = 0; c < before.names.size(); ++c) {
    EXPECT_EQ(signal.names[c], before.names[c]);
    for (std::size_t i = 0; i < 500; ++i) ASSERT_EQ(signal.at(i, c), before.at(i, c));
  }
  for (std::size_t c = before.names.size(); c < signal.names.size(); ++c) {
    const int fap = fap_of_channel(signal.names[c]);
    EXPECT_TRUE((fap >= 19 && fap <= 26) || (fap >= 31 && fap <= 50) || fap == 61 || fap == 62)
        << fap;
  }
}

TEST(IdleMotion, KeepsWhatTheCharacterHasLearned) {
  Signal signal = mouth(100, {"fap3_open_jaw", "fap31_raise_l_i_eyebrow"});
  ASSERT_TRUE(add_idle_motion(signal, phrases()));
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(signal.at(i, 0), 7);
    EXPECT_EQ(signal.at(i, 1), 7);
  }
}

TEST(IdleMotion, BeginsAndEndsAtRest) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Signal signal = mouth(400);
    ASSERT_TRUE(add_idle_motion(signal, phrases(), {2, seed}));
    for (const int fap : {31, 33, 37, 41, 50, 61}) {
      EXPECT_EQ(signal.at(0, channel(signal, fap)), 0) << fap;
      EXPECT_NEAR(signal.at(399, channel(signal, fap)), 0, 1e-9) << fap;
    }
    for (const int fap : {48, 49}) {  // where the head still comes back from a look aside
      EXPECT_EQ(signal.at(0, channel(signal, fap)), 0);
      EXPECT_NEAR(signal.at(399, channel(signal, fap)), 0, 0.3 * kDegree);
    }
    for (const std::size_t frame : {std::size_t(0), std::size_t(399)}) {
      EXPECT_NEAR(signal.at(frame, channel(signal, 19)), 0, 15) << "open eyes";
      const double yaw =
          signal.at(frame, channel(signal, 23)) + signal.at(frame, channel(signal, 24));
      EXPECT_LT(std::abs(yaw / 2), 2 * kDegree) << "that look at the viewer";
    }
  }
}

TEST(IdleMotion, TheHeadMovesAsPeopleDo) {
  double pitch = 0, yaw = 0, roll = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Signal signal = moved({1, seed}, 120);
    pitch += deviation(curve(signal, 48)) / 5 / kDegree;
    yaw += deviation(curve(signal, 49)) / 5 / kDegree;
    roll += deviation(curve(signal, 50)) / 5 / kDegree;
    for (const int fap : {48, 49, 50}) {
      const auto values = curve(signal, fap);
      for (std::size_t i = 1; i < values.size(); ++i) {
        ASSERT_LT(std::abs(values[i]), 30 * kDegree);
        ASSERT_LT(std::abs(values[i] - values[i - 1]) * 50, 120 * kDegree) << "a second";
      }
    }
  }
  EXPECT_GT(pitch, 2);
  EXPECT_LT(pitch, 4);
  EXPECT_GT(yaw, 2);
  EXPECT_LT(yaw, 4);
  EXPECT_GT(roll, 1);
  EXPECT_LT(roll, 2);
}

TEST(IdleMotion, LivelinessScalesAndSwitchesOff) {
  const double usual = deviation(curve(moved({1, 2}), 48));
  EXPECT_GT(deviation(curve(moved({2, 2}), 48)), 1.5 * usual);
  EXPECT_LT(deviation(curve(moved({0.3, 2}), 48)), 0.6 * usual);
  IdleMotionOptions off{0, 2};
  off.still.brows = true;
  EXPECT_EQ(moved(off).names.size(), 1u);
}

// The text asks for them, as it asks for moods by emoji.
TEST(IdleMotion, QuestionsRaiseBrowsWithoutLife) {
  const Script script = talk(60);
  const Signal questions = moved({0, 2});
  std::set<int> faps;
  for (const std::string& name : questions.names) faps.insert(fap_of_channel(name));
  EXPECT_EQ(faps, (std::set<int>{3, 31, 32, 33, 34, 35, 36}));
  const std::vector<double> brow = curve(questions, 33);
  const auto phrases = plan_speech(script).phrases;
  std::size_t raised = 0, asked = 0;
  double still = 0;
  for (const SpeechPhrase& phrase : phrases) {
    if (phrase.end > 57) break;  // it ends at rest
    const double highest = *std::max_element(brow.begin() + std::ptrdiff_t(50 * phrase.start),
                                             brow.begin() + std::ptrdiff_t(50 * phrase.end));
    asked += phrase.question ? 1 : 0;
    raised += phrase.question && highest > 40 ? 1 : 0;
  }
  // Long before a question nothing moves.
  for (std::size_t i = 1; i < phrases.size(); ++i) {
    const bool near = phrases[i].question || phrases[i - 1].question;
    if (near || phrases[i].end > 57) continue;
    const double late = phrases[i].end - 0.01;
    if (i + 1 < phrases.size() && phrases[i + 1].question && phrases[i + 1].end - late < 0.8)
      continue;
    still = std::max(still, std::abs(brow[std::size_t(50 * late)]));
  }
  EXPECT_GE(asked, 5u);
  EXPECT_EQ(raised, asked);
  EXPECT_EQ(still, 0);

  Signal told = mouth(200);
  ASSERT_TRUE(add_idle_motion(told, idle_motion_test::phrases(), {0, 1}));
  EXPECT_EQ(told.names.size(), 1u) << "no question, no further FAPs";

  Signal shapes = mouth(60 * 50, {"jawOpen"});
  ASSERT_TRUE(add_idle_motion(shapes, script, {0, 2}));
  EXPECT_EQ(shapes.names, (std::vector<std::string>{"jawOpen", "browInnerUp", "browOuterUpLeft",
                                                    "browOuterUpRight"}));
}

TEST(IdleMotion, PartsStayStill) {
  const auto has = [](const char* still) {
    IdleMotionOptions options;
    options.still = *parse_still(still);
    const Signal signal = moved(options, 10);
    std::string faps;
    for (const std::string& name : signal.names) faps += std::to_string(fap_of_channel(name)) + " ";
    return faps;
  };
  EXPECT_EQ(has("gaze"), "3 19 20 21 22 31 32 33 34 35 36 37 38 41 42 48 49 50 61 62 ");
  EXPECT_EQ(has("head,brows"), "3 19 20 21 22 23 24 25 26 ");
  EXPECT_EQ(has("gaze,blinks"), "3 31 32 33 34 35 36 37 38 41 42 48 49 50 61 62 ");
  EXPECT_EQ(has("gaze,head,brows,blinks"), "3 ");
  // What is still does not change the rest.
  IdleMotionOptions options;
  options.still.brows = true;
  EXPECT_EQ(curve(moved(options), 49), curve(moved({}), 49));
}

TEST(IdleMotion, EyesTurnAgainstTheHead) {
  // Without looks away what remains is the motion of the head, the other way round.
  const Signal signal = moved({1, 4}, 60);
  const auto head = curve(signal, 49), left = curve(signal, 23), right = curve(signal, 24);
  double against = 0, all = 0;
  for (std::size_t i = 1; i < head.size(); ++i) {
    const double eye = 0.5 * (left[i] + right[i] - left[i - 1] - right[i - 1]);
    const double turn = head[i] - head[i - 1];
    if (std::abs(turn) < 0.05 * kDegree || std::abs(eye) > kDegree) continue;  // a saccade
    all += 1;
    against += std::abs(eye + turn) < 0.4 * std::abs(turn) + 0.08 * kDegree ? 1 : 0;
  }
  ASSERT_GT(all, 500);
  EXPECT_GT(against / all, 0.9);
}

TEST(IdleMotion, LidsFollowTheEyes) {
  IdleMotionOptions options;
  options.still.blinks = options.still.brows = true;
  const Signal signal = moved(options);
  const auto lid = curve(signal, 19), lower = curve(signal, 21), eye = curve(signal, 25);
  double lowest = 0, highest = 0;
  for (std::size_t i = 0; i < lid.size(); ++i) {
    if (eye[i] > 3 * kDegree) {
      EXPECT_GT(lid[i], 0);
    }
    if (eye[i] < -3 * kDegree) {
      EXPECT_LT(lid[i], 0);
    }
    EXPECT_LE(lower[i] * eye[i], 0);
    lowest = std::max(lowest, lid[i]);
    highest = std::min(highest, lid[i]);
  }
  EXPECT_GT(lowest, 60);
  EXPECT_LT(highest, -30);
}

TEST(IdleMotion, LooksWhereItIsTold) {
  const auto mean_gaze = [](const char* target, int eye, int head) {
    IdleMotionOptions options;
    options.look = *parse_look(target);
    const Signal signal = moved(options, 60);
    auto eyes = curve(signal, eye), other = curve(signal, eye + 1), turn = curve(signal, head);
    for (std::size_t i = 0; i < eyes.size(); ++i) eyes[i] = 0.5 * (eyes[i] + other[i]) + turn[i];
    std::nth_element(eyes.begin(), eyes.begin() + 1500, eyes.end());
    return eyes[1500] / kDegree;
  };
  EXPECT_NEAR(mean_gaze("30,0", 23, 49), 30, 3);
  EXPECT_NEAR(mean_gaze("-20,10", 23, 49), -20, 3);
  EXPECT_NEAR(mean_gaze("-20,10", 25, 48), -10, 3) << "up is negative";
  EXPECT_NEAR(mean_gaze("0.5,0,0.5", 23, 49), 45, 3);
  EXPECT_NEAR(mean_gaze("camera", 23, 49), 0, 1);
  IdleMotionOptions options;
  options.look.kind = Look::Kind::away;
  const Signal signal = moved(options);
  const auto yaw = curve(signal, 23), pitch = curve(signal, 25);
  const auto yaw2 = curve(signal, 24), head = curve(signal, 49), nod = curve(signal, 48);
  std::size_t met = 0;
  for (std::size_t i = 0; i < yaw.size(); ++i) {
    const double across = 0.5 * (yaw[i] + yaw2[i]) + head[i];
    met += std::hypot(across, pitch[i] + nod[i]) < 4 * kDegree ? 1 : 0;
  }
  EXPECT_LT(double(met), 0.08 * double(yaw.size())) << "it only passes the viewer";
}

TEST(IdleMotion, NearThingsAreLookedAtWithBothEyes) {
  IdleMotionOptions options;
  options.look = *parse_look("0,0,0.25");
  const Signal signal = moved(options, 30);
  auto across = curve(signal, 23);
  const auto right = curve(signal, 24);
  for (std::size_t i = 0; i < across.size(); ++i) across[i] -= right[i];
  std::nth_element(across.begin(), across.begin() + 750, across.end());
  EXPECT_NEAR(across[750], -14.4 * kDegree, kDegree) << "63 mm at 250 mm";
}

TEST(IdleMotion, BrowsRiseAtQuestions) {
  // 12 sentences of one word, all of them questions.
  Script script;
  for (int i = 0; i < 12; ++i) {
    const double at = 3 * i;
    script.phones.push_back({at, at + 2, "SIL", ""});
    script.phones.push_back({at + 2, at + 2.4, "R", "really?"});
    script.phones.push_back({at + 2.4, at + 3, "IY", "really?"});
  }
  const auto raised = [&](const char* mark) {
    Script marked = script;
    for (Phone& phone : marked.phones)
      if (phone.label != "SIL") phone.word = "really" + std::string(mark);
    Signal signal = mouth(40 * 50);
    EXPECT_TRUE(add_idle_motion(signal, marked));
    const auto brow = curve(signal, 33);
    int count = 0;
    for (int i = 0; i < 12; ++i) count += brow[std::size_t(50 * (3 * i + 2.95))] > 35 ? 1 : 0;
    return count;
  };
  EXPECT_GE(raised("?"), 7);
  EXPECT_GE(raised("?\xE2\x80\x9D"), 7) << "in quotes";
  EXPECT_LE(raised("."), 5);
}

TEST(IdleMotion, ChecksWhatItGets) {
  Signal rig = mouth(10, {"snout"});
  EXPECT_EQ(add_idle_motion(rig, phrases()).error().code, Code::unsupported);
  Signal signal = mouth(10);
  EXPECT_FALSE(add_idle_motion(signal, phrases(), {-1, 1}));
  EXPECT_FALSE(add_idle_motion(signal, phrases(), {2.1, 1}));
  EXPECT_FALSE(add_idle_motion(signal, phrases(), {std::nan(""), 1}));
  signal.first_frame = 3;
  EXPECT_FALSE(add_idle_motion(signal, phrases()));
  Signal still = mouth(100);
  EXPECT_TRUE(add_idle_motion(still, {{{0, 2, "SIL", ""}}}));  // silence lives, too
  Signal empty = mouth(0);
  EXPECT_TRUE(add_idle_motion(empty, {}));
}

TEST(IdleMotion, ArkitShapesHaveIt) {
  Signal signal = mouth(1500, {"JawOpen", "EyeBlinkLeft", "EyeWideLeft", "BrowInnerUp"});
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    signal.at(i, 0) = 0.3;
    signal.at(i, 1) = 0.1;
    signal.at(i, 2) = 0.2;
    signal.at(i, 3) = 0.05;
  }
  const auto report = add_idle_motion(signal, talk(28));
  ASSERT_TRUE(report) << report.error().describe();
  const std::vector<std::string> wanted = {
      "JawOpen",          "EyeBlinkLeft",    "EyeWideLeft",      "BrowInnerUp",
      "EyeBlinkRight",    "EyeLookInLeft",   "EyeLookInRight",   "EyeLookOutLeft",
      "EyeLookOutRight",  "EyeLookUpLeft",   "EyeLookUpRight",   "EyeLookDownLeft",
      "EyeLookDownRight", "BrowOuterUpLeft", "BrowOuterUpRight", "BrowDownLeft",
      "BrowDownRight",    "CheekSquintLeft", "CheekSquintRight", "HeadPitch",
      "HeadYaw",          "HeadRoll"};
  EXPECT_EQ(signal.names, wanted);
  double left = 0, brow = 0, head = 0;
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    EXPECT_EQ(signal.at(i, 0), 0.3);
    EXPECT_GE(signal.at(i, 1), 0.1) << "its own lids stay at least as far closed";
    EXPECT_NEAR(signal.at(i, 2), 0.2 * (1 - signal.at(i, 4)), 1e-12) << "wide gives way";
    EXPECT_GE(signal.at(i, 3), 0.05);
    for (std::size_t c = 4; c < 19; ++c) {
      EXPECT_GE(signal.at(i, c), 0) << signal.names[c];
      EXPECT_LE(signal.at(i, c), 1) << signal.names[c];
    }
    left = std::max(left, signal.at(i, 1));
    brow = std::max(brow, signal.at(i, 3));
    head = std::max(head, std::abs(signal.at(i, 19)));
  }
  EXPECT_DOUBLE_EQ(left, 1);
  EXPECT_GT(brow, 0.1);
  EXPECT_LE(brow, 1);
  EXPECT_GT(head, 0.03);
  EXPECT_LT(head, 0.3) << "radians";
}

TEST(IdleMotion, ArkitAndFapsMoveAlike) {
  Signal shapes = mouth(1500, {"jawOpen"}), faps = mouth(1500);
  std::fill(shapes.values.begin(), shapes.values.end(), 0.0);
  ASSERT_TRUE(add_idle_motion(shapes, talk(28)));
  ASSERT_TRUE(add_idle_motion(faps, talk(28)));
  const auto clip = to_sequence(shapes);
  ASSERT_TRUE(clip);
  for (const int fap : {23, 24, 25, 26, 48, 49, 50}) {
    const auto values = curve(faps, fap);
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(clip->frames[i].value[std::size_t(fap)], values[i], 3) << fap << ", frame " << i;
  }
  // Inner ends have one shape for both sides.
  const auto left = curve(faps, 31), right = curve(faps, 32), outer = curve(faps, 36);
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (left[i] <= 0 || right[i] <= 0) continue;
    const double mean = 0.5 * (clip->frames[i].value[31] + clip->frames[i].value[32]);
    EXPECT_NEAR(mean, 0.5 * (left[i] + right[i]), 14) << i;
    EXPECT_NEAR(clip->frames[i].value[36], outer[i], 14) << i;
  }
}

}  // namespace idle_motion_test
}  // namespace animeme::dam
