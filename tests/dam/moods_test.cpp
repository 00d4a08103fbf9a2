#include "dam/speaking/moods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dam/model/builtin.h"
#include "dam/script/phones.h"
#include "dam/signal/arkit_signal.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/synthesise.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace moods_test {

const Model& model() {
  static const Model built = *builtin_model();
  return built;
}

/// Every phone at random, with one of each kind between random neighbours.
Script speech(std::uint32_t seed, std::size_t phones = 60) {
  std::vector<std::string> labels;
  for (const PhoneInfo& phone : dam::phones())
    if (phone.label != kSilence) labels.emplace_back(phone.label);
  for (const char* often : {"P", "B", "M", "F", "V", "UW", "UW", "W"}) labels.emplace_back(often);
  test::Uniform random(seed);
  return test::random_script(random, labels, phones);
}

Signal spoken(const Script& script, fap::Rate rate = {25, 1}) {
  SynthesisOptions options;
  options.rate = rate;
  options.articulation = std::nullopt;
  auto signal = synthesise(model(), script, options);
  EXPECT_TRUE(signal);
  return *signal;
}

Signal with(Signal signal, const Script& script, const MoodTrack& track) {
  const auto added = add_moods(signal, script, track);
  EXPECT_TRUE(added) << added.error().describe();
  return signal;
}

std::ptrdiff_t channel(const Signal& signal, int fap) {
  for (std::size_t c = 0; c < signal.names.size(); ++c)
    if (fap_of_channel(signal.names[c]) == fap) return std::ptrdiff_t(c);
  return -1;
}

double value(const Signal& signal, std::size_t frame, int fap) {
  const auto c = channel(signal, fap);
  return c < 0 ? 0 : signal.at(frame, std::size_t(c));
}

std::vector<Mood> all_moods() {
  std::vector<Mood> all;
  for (const std::string& name : mood_names()) all.push_back({name, 1});
  return all;
}

TEST(Moods, NamesAndWhatIsLikeThem) {
  EXPECT_EQ(*read_mood("joy"), (Mood{"joy", 1}));
  EXPECT_EQ(*read_mood(" Joy : 0.25 "), (Mood{"joy", 0.25}));
  EXPECT_EQ(*read_mood("cheerful"), (Mood{"joy", 0.8}));
  EXPECT_EQ(*read_mood("Poetry-Reading:0.5"), (Mood{"calm", 0.4}));
  EXPECT_EQ(*read_mood("sports_commentary_excited:2"), (Mood{"excited", 1}));
  EXPECT_TRUE(read_mood("neutral")->neutral());
  EXPECT_TRUE(read_mood("joy:0")->neutral());
  for (const std::string& name : mood_names()) EXPECT_EQ(read_mood(name)->name, name);
  const auto wrong = read_mood("angre");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Code::not_found);
  EXPECT_NE(wrong.error().message.find("did you mean ang"), std::string::npos)
      << wrong.error().message;
  EXPECT_NE(read_mood("zzzzzzzzzzzz").error().message.find("whispering"), std::string::npos);
  for (const char* text : {"joy:", "joy:x", "joy:-1", "joy:2.5", "joy:nan", "joy:1:1"})
    EXPECT_EQ(read_mood(text).error().code, Code::invalid_argument) << text;
  EXPECT_EQ(mood_text({"joy", 1}), "joy");
  EXPECT_EQ(*read_mood(mood_text({"joy", 0.3})), (Mood{"joy", 0.3}));
}

TEST(Moods, EachHasAFaceOfItsOwn) {
  std::vector<MoodPose> poses;
  for (const Mood& mood : all_moods()) {
    const MoodPose pose = mood_pose(mood);
    EXPECT_EQ(pose.neutral(), mood.neutral()) << mood.name;
    for (const MoodPose& other : poses) EXPECT_NE(pose.fap, other.fap) << mood.name;
    poses.push_back(pose);
    for (int f = 1; f <= fap::kFapCount; ++f) {
      const auto& info = fap::info(f);
      const double most = 0.7 * info.default_i_range * info.quant_step;
      EXPECT_LE(std::abs(pose.fap[std::size_t(f)]), most) << mood.name << " FAP " << f;
      EXPECT_TRUE(pose.fap[std::size_t(f)] == 0 || mood_faps()[std::size_t(f)]);
    }
  }
}

TEST(Moods, NoneChangesNothing) {
  const Script script = speech(1);
  const Signal plain = spoken(script);
  Signal signal = plain;
  const std::vector<MoodSpan> louder = {{0, 2, std::nullopt, 1.5}, {1, 2, Mood{"joy", 0}, 1}};
  ASSERT_TRUE(add_moods(signal, script, MoodTrack({}, louder)));
  EXPECT_EQ(signal.names, plain.names);
  EXPECT_EQ(signal.values, plain.values);
  Signal rig;
  rig.rate = {25, 1};
  rig.names = {"handle"};
  rig.values = {1};
  EXPECT_TRUE(add_moods(rig, script, MoodTrack()));
  EXPECT_EQ(add_moods(rig, script, MoodTrack(Mood{"joy", 1})).error().code, Code::unsupported);
}

TEST(Moods, LipsCloseAsTheyDoWithout) {
  std::size_t checked = 0;
  for (const std::uint32_t seed : {1, 2, 3}) {
    const Script script = speech(seed);
    for (const fap::Rate rate : {fap::Rate{25, 1}, {60, 1}}) {
      const Signal plain = spoken(script, rate);
      const auto lips = inner_lip_channels(plain.names);
      ASSERT_TRUE(lips);
      for (const Mood& mood : all_moods()) {
        const Signal moody = with(plain, script, MoodTrack(mood));
        for (const Phone& phone : script.phones) {
          if (!is_bilabial(phone.label)) continue;
          const auto before = closed_span(plain, phone, *lips, 0.3);
          const auto after = closed_span(moody, phone, *lips, 0.3);
          ASSERT_TRUE(before && after) << mood.name << " at " << phone.start;
          // Lips that rest behind it may open as the mood says.
          const double held =
              model().closure_duration->of(phone.duration()) * rate.frames_per_second();
          EXPECT_GE(after->frames(), std::min(held, before->frames()) - 0.35)
              << mood.name << " " << phone.start;
          EXPECT_LE(inner_gap(moody, after->least, *lips), model().closure_gap + 1e-9);
          ++checked;
        }
        for (std::size_t i = 0; i < plain.frames(); ++i) {
          const double least = std::min(inner_gap(plain, i, *lips), -60.0);
          ASSERT_GE(inner_gap(moody, i, *lips), least - 1e-9) << mood.name << " frame " << i;
        }
      }
    }
  }
  EXPECT_GT(checked, 1000u);
}

TEST(Moods, TheLowerLipReachesTheTeeth) {
  std::size_t checked = 0;
  for (const std::uint32_t seed : {4, 5}) {
    const Script script = speech(seed);
    const Signal plain = spoken(script);
    for (const Mood& mood : all_moods()) {
      const Signal moody = with(plain, script, MoodTrack(mood));
      for (const Phone& phone : script.phones) {
        if (!is_labiodental(phone.label)) continue;
        const FrameSpan span = frames_near(plain, phone, kClosureSearch);
        for (std::size_t i = span.first; i < span.last; ++i)
          for (const int fap : {4, 5, 10, 11, 52})
            EXPECT_NEAR(value(moody, i, fap), value(plain, i, fap), 1e-9)
                << mood.name << " FAP " << fap;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 100u);
}

TEST(Moods, RoundVowelsStayRound) {
  std::size_t checked = 0;
  for (const std::uint32_t seed : {6, 7, 8}) {
    const Script script = speech(seed);
    const Signal plain = spoken(script, {100, 1});
    for (const Mood& mood : all_moods()) {
      const Signal moody = with(plain, script, MoodTrack(mood));
      for (const Phone& phone : script.phones) {
        if (phone.label != "UW") continue;
        const auto i = std::size_t(std::lround((phone.start + phone.end) / 2 * 100));
        for (const int fap : {6, 7}) {
          const double narrow = value(plain, i, fap);
          if (narrow > -5) continue;
          EXPECT_LE(value(moody, i, fap), 0.6 * narrow) << mood.name << " " << phone.start;
        }
        for (const int fap : {16, 17})
          EXPECT_GE(value(moody, i, fap), 0.6 * value(plain, i, fap)) << mood.name;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 100u);
}

TEST(Moods, TheRestOfTheFaceMovesFully) {
  const Script script = speech(9);
  const Signal plain = spoken(script);
  const MoodPose joy = mood_pose({"joy", 1}), anger = mood_pose({"anger", 1});
  const Signal glad = with(plain, script, MoodTrack(Mood{"joy", 1}));
  const Signal angry = with(plain, script, MoodTrack(Mood{"anger", 1}));
  double corners = 0;
  for (std::size_t i = 0; i < plain.frames(); ++i) {
    for (const int fap : {19, 21, 31, 33, 35, 41, 42})
      EXPECT_DOUBLE_EQ(value(glad, i, fap), joy.fap[std::size_t(fap)]) << fap;
    for (const int fap : {31, 32, 37, 38, 61})
      EXPECT_DOUBLE_EQ(value(angry, i, fap), anger.fap[std::size_t(fap)]) << fap;
    corners += value(glad, i, 12) - value(plain, i, 12);
  }
  EXPECT_GT(corners / double(plain.frames()), 0.6 * joy.fap[12]) << "a smile is seen in speech";
}

// A side that is never sent takes the value of the other one in decoders.
TEST(Moods, OneSidedPosesStayOneSided) {
  const Script script = speech(9);
  const Signal plain = spoken(script);
  std::size_t one_sided = 0;
  for (const Mood& mood : all_moods()) {
    const MoodPose pose = mood_pose(mood);
    const Signal moody = with(plain, script, MoodTrack(mood));
    for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
      const int other = fap::info(f).mirror;
      if (pose.fap[std::size_t(f)] == 0 || other == 0) continue;
      EXPECT_TRUE(pose.faps()[std::size_t(other)]) << mood.name << " FAP " << f;
      const auto& names = moody.names;
      EXPECT_NE(std::find(names.begin(), names.end(), fap_channel(other)), names.end())
          << mood.name << " FAP " << other;
      one_sided += pose.fap[std::size_t(other)] == 0;
    }
  }
  EXPECT_GT(one_sided, 0u);
}

TEST(Moods, LidsThatBlinkClose) {
  Script script{{{0, 30, "SIL", ""}}};
  Signal signal = spoken(script, {100, 1});
  ASSERT_TRUE(add_idle_motion(signal, script));
  const Signal plain = signal;
  for (const Mood& mood : all_moods()) {
    const Signal moody = with(plain, script, MoodTrack(mood));
    for (std::size_t i = 0; i < plain.frames(); ++i) {
      const double shut = value(plain, i, 19) + value(plain, i, 21);
      if (shut < 1023) continue;
      EXPECT_NEAR(value(moody, i, 19) + value(moody, i, 21), shut, 1) << mood.name;
    }
  }
}

TEST(Moods, OneFollowsTheOtherWithoutAJump) {
  test::Uniform random(10);
  const std::vector<Mood> moods = all_moods();
  MoodPose low, high;  // of all moods
  for (const Mood& mood : moods) {
    const MoodPose pose = mood_pose(mood);
    for (std::size_t f = 0; f < pose.fap.size(); ++f) {
      low.fap[f] = std::min(low.fap[f], pose.fap[f]);
      high.fap[f] = std::max(high.fap[f], pose.fap[f]);
    }
  }
  for (int round = 0; round < 20; ++round) {
    MoodBlend blend;
    double at = 0;
    MoodPose before = blend.at(0);
    for (int frame = 1; frame < 400; ++frame) {
      at = 0.01 * frame;
      // Changes in quick succession, some of them in the future, and taken back.
      if (random(0, 1) < 0.1) {
        const Mood mood{moods[random.below(moods.size())].name, random(0, 1)};
        blend.change(at - 0.01 + (random(0, 1) < 0.5 ? 0 : random(0, 0.5)), mood);
      }
      if (random(0, 1) < 0.05) blend.forget(at - 0.01);
      const MoodPose now = blend.at(at);
      for (int fap = 3; fap <= fap::kFapCount; ++fap) {
        const double least = low.fap[std::size_t(fap)], largest = high.fap[std::size_t(fap)];
        const double v = now.fap[std::size_t(fap)];
        EXPECT_GE(v, least - 1e-6);
        EXPECT_LE(v, largest + 1e-6);
        const double step = std::abs(v - before.fap[std::size_t(fap)]);
        ASSERT_LE(step, 0.01 / 0.4 * 1.6 * (largest - least) + 1e-9) << "FAP " << fap;
      }
      before = now;
    }
  }
}

TEST(Moods, SpansInSpans) {
  const Mood joy{"joy", 0.5}, fear{"fear", 1};
  const std::vector<MoodSpan> spans = {
      {1, 9, joy, 1}, {3, 5, fear, 1}, {4, 6, std::nullopt, 1.5}, {7, 7, fear, 1}};
  const MoodTrack track(Mood{"calm", 1}, spans);
  const auto& parts = track.parts();
  ASSERT_EQ(parts.size(), 6u);
  EXPECT_EQ(parts[0].mood, (Mood{"calm", 1}));
  EXPECT_EQ(parts[0].start, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(parts[1].mood, joy);
  EXPECT_EQ(parts[2].mood, fear) << "full is full";
  EXPECT_EQ(parts[3].mood, (Mood{"joy", 0.75}));
  EXPECT_EQ(parts[4].mood, joy);
  EXPECT_EQ(parts[4].start, 6);
  EXPECT_EQ(parts[5].start, 9);
  const std::vector<MoodSpan> near = {{1, 2, joy, 1}, {2.4, 3, joy, 1}, {4, 5, joy, 1}};
  EXPECT_EQ(MoodTrack({}, near).parts().size(), 5u) << "two sentences, then a pause, then one";
  const MoodBlend blend = track.blend();
  EXPECT_EQ(blend.at(8.5).fap, mood_pose(joy).fap);
  EXPECT_EQ(blend.at(0).fap, mood_pose({"calm", 1}).fap);
}

TEST(Moods, ShapesOfArkit) {
  const Script script = speech(11, 20);
  Signal signal;
  signal.rate = {50, 1};
  signal.names = {"JawOpen", "MouthSmileLeft", "MouthSmileRight", "EyeBlinkLeft", "EyeBlinkRight"};
  const auto frames = std::size_t(script.duration() * 50);
  for (std::size_t i = 0; i < frames; ++i)
    for (const double v : {0.3, 0.0, 0.0, i < 10 ? 1.0 : 0.0, i < 10 ? 1.0 : 0.0})
      signal.values.push_back(v);
  const Signal glad = with(signal, script, MoodTrack(Mood{"joy", 1}));
  const auto column = [&](const std::string& name) {
    const auto at = std::find(glad.names.begin(), glad.names.end(), name);
    EXPECT_NE(at, glad.names.end()) << name;
    return std::size_t(at - glad.names.begin());
  };
  double smile = 0;
  for (std::size_t i = 0; i < glad.frames(); ++i) {
    smile += glad.at(i, column("MouthSmileLeft")) / double(glad.frames());
    EXPECT_LE(glad.at(i, column("MouthSmileLeft")), 1);
  }
  EXPECT_GT(smile, 0.2);
  EXPECT_GT(
      glad.at(frames / 2, column("CheekSquintLeft")) + glad.at(frames / 2, column("EyeSquintLeft")),
      0.05);
  EXPECT_EQ(glad.at(0, column("EyeBlinkLeft")), 1);
}

TEST(Moods, FapTwo) {
  const Script script = speech(12, 20);
  const MoodTrack track(Mood{"excited", 1});
  auto clip = to_sequence(with(spoken(script), script, track));
  ASSERT_TRUE(clip);
  fap::Sequence beside = *clip, instead = *clip;
  show_expressions(track, beside, ExpressionPlace::beside);
  show_expressions(track, instead, ExpressionPlace::instead);
  for (std::size_t i = 0; i < clip->frames.size(); ++i) {
    const fap::Expression& shown = beside.frames[i].expression;
    EXPECT_EQ(shown, (fap::Expression{1, 50, 6, 19, false, false}));
    EXPECT_EQ(beside.frames[i].value, clip->frames[i].value);
    EXPECT_TRUE(instead.frames[i].mask[2]);
    EXPECT_FALSE(instead.frames[i].mask[31]);
    EXPECT_TRUE(instead.frames[i].mask[12]);
    EXPECT_EQ(instead.frames[i].value[31], 0);
  }
  for (const Mood& mood : all_moods()) {
    fap::Sequence one = *clip;
    show_expressions(MoodTrack(mood), one, ExpressionPlace::beside);
    const fap::Expression& e = one.frames.front().expression;
    EXPECT_TRUE(e.select1 == 0 ? e.intensity1 == 0 : e.intensity1 > 0) << mood.name;
    EXPECT_TRUE(e.select2 == 0 ? e.intensity2 == 0 : e.intensity2 > 0) << mood.name;
    EXPECT_NE(e.select1 + 10 * (e.select1 == 0), e.select2) << mood.name;
  }
}

}  // namespace moods_test
}  // namespace animeme::dam
