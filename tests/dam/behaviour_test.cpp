#include "dam/behaviour/behaviour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace animeme::dam {
namespace behaviour_test {

constexpr double kDegrees = 57.29578;

Behaviour behaviour_of(const BehaviourOptions& options) {
  auto made = Behaviour::make(options);
  EXPECT_TRUE(made);
  return std::move(*made);
}

SpeechPlan plan_of(double seconds, const char* word = "word") {
  Script script;
  for (double at = 0; at < seconds; at += 0.3) {
    script.phones.push_back({at, at + 0.1, "T", word});
    script.phones.push_back({at + 0.1, at + 0.3, "EY", word});
  }
  return plan_speech(script);
}

/// The largest step of each value that has one, in degrees or units; saccades and blinks aside.
void expect_smooth(const FaceMoment& a, const FaceMoment& b, double frame, int at) {
  const auto near = [&](double from, double to, double a_second, const char* what) {
    EXPECT_LE(std::abs(to - from), a_second * frame) << what << ", moment " << at;
  };
  near(a.head_pitch * kDegrees, b.head_pitch * kDegrees, 150, "pitch");
  near(a.head_yaw * kDegrees, b.head_yaw * kDegrees, 150, "yaw");
  near(a.head_roll * kDegrees, b.head_roll * kDegrees, 100, "roll");
  for (std::size_t side = 0; side < 2; ++side) {
    near(a.inner_brow[side], b.inner_brow[side], 3200, "inner brow");
    near(a.middle_brow[side], b.middle_brow[side], 3200, "brow");
    near(a.outer_brow[side], b.outer_brow[side], 3200, "outer brow");
    near(a.squeeze[side], b.squeeze[side], 1100, "squeeze");
    near(a.eye_yaw[side] * kDegrees, b.eye_yaw[side] * kDegrees, 700, "eye");
    near(a.eye_pitch[side] * kDegrees, b.eye_pitch[side] * kDegrees, 700, "eye");
  }
  near(a.blink, b.blink, 40, "lids");
  near(a.cheek, b.cheek, 500, "cheek");
}

TEST(Behaviour, NothingJumpsWhateverItIsTold) {
  BehaviourOptions options;
  options.rate = {100, 1};
  options.liveliness = 2;
  Behaviour behaviour = behaviour_of(options);
  const char* targets[] = {"camera", "away", "40,-10", "-0.3,0.2,0.6", "-60,40"};
  FaceMoment before = behaviour.next();
  std::uint32_t random = 12345;
  const auto below = [&](std::uint32_t count) {
    random = random * 1664525u + 1013904223u;
    return (random >> 16) % count;
  };
  for (int i = 1; i < 60000; ++i) {  // ten minutes; something happens every second or so
    if (below(100) == 0) {
      switch (below(5)) {
        case 0:
          behaviour.speak(plan_of(0.3 + 0.5 * below(10), below(2) == 0 ? "what?" : "word!"),
                          0.1 * below(10));
          break;
        case 1:
          behaviour.hush();
          break;
        case 2:
          behaviour.look(*parse_look(targets[below(5)]));
          break;
        case 3:
          behaviour.hear(below(2) == 0);
          break;
        default:
          behaviour.set_activity(Activity(below(3)));
      }
    }
    const FaceMoment moment = behaviour.next();
    expect_smooth(before, moment, 0.01, i);
    before = moment;
    if (HasFailure()) return;
  }
}

TEST(Behaviour, TellingInPartsIsTellingAtOnce) {
  // Phrases that are told when they begin look like those told in advance: the same kind of head,
  // and speech all the time.
  const SpeechPlan plan = plan_of(4);
  Behaviour behaviour = behaviour_of({});
  double moved = 0;
  FaceMoment before = behaviour.next();
  for (int i = 0; i < 25 * 60; ++i) {
    if (i % 110 == 0) behaviour.speak(plan);
    const FaceMoment moment = behaviour.next();
    moved += std::abs(moment.head_pitch - before.head_pitch);
    before = moment;
  }
  EXPECT_GT(moved * kDegrees / 60, 2) << "degrees a second";
  EXPECT_GT(behaviour.counts().nods, 6u);
  EXPECT_GT(behaviour.counts().raises, 4u);
}

TEST(Behaviour, HushEndsWhatWasPlanned) {
  Behaviour behaviour = behaviour_of({});
  behaviour.speak(plan_of(30), 0.5);
  for (int i = 0; i < 50; ++i) behaviour.next();
  behaviour.hush();
  Behaviour quiet = behaviour;
  for (int i = 0; i < 50; ++i) quiet.next();  // what had begun ends
  double moved = 0, talked = 0;
  for (int i = 0; i < 500; ++i) {
    const double before = quiet.next().head_pitch;
    moved += std::abs(quiet.next().head_pitch - before);
  }
  Behaviour talking = behaviour_of({});
  talking.speak(plan_of(60), 0.5);
  for (int i = 0; i < 100; ++i) talking.next();
  for (int i = 0; i < 500; ++i) {
    const double before = talking.next().head_pitch;
    talked += std::abs(talking.next().head_pitch - before);
  }
  EXPECT_LT(moved, 0.6 * talked);
}

TEST(Behaviour, WaitsInThreeWays) {
  const auto contact = [](Activity activity) {
    double share = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      BehaviourOptions options;
      options.seed = seed;
      Behaviour behaviour = behaviour_of(options);
      behaviour.set_activity(activity);
      for (int i = 0; i < 3000; ++i) {
        const FaceMoment m = behaviour.next();
        const double yaw = 0.5 * (m.eye_yaw[0] + m.eye_yaw[1]) + m.head_yaw;
        const double pitch = 0.5 * (m.eye_pitch[0] + m.eye_pitch[1]) + m.head_pitch;
        share += std::hypot(yaw, pitch) * kDegrees < 3.5 ? 1.0 / 12000 : 0;
      }
    }
    return share;
  };
  const double idle = contact(Activity::idle), listening = contact(Activity::listening);
  EXPECT_GT(listening, 0.85);
  EXPECT_GT(idle, 0.65);
  EXPECT_LT(idle, listening);
  EXPECT_LT(contact(Activity::thinking), 0.5);
}

/// Nods of the head in these moments of 0.01 s, by the time of their beginnings: it goes down by a
/// degree within 0.2 s.
std::vector<double> nods_of(const std::vector<FaceMoment>& moments) {
  std::vector<double> nods;
  for (std::size_t i = 20; i < moments.size(); ++i) {
    const double down = (moments[i].head_pitch - moments[i - 20].head_pitch) * kDegrees;
    const double time = 0.01 * double(i - 20);
    if (down > 1 && (nods.empty() || time > nods.back() + 0.8)) nods.push_back(time);
  }
  return nods;
}

TEST(Behaviour, NodsWhereTheOtherPauses) {
  std::size_t pauses = 0, nodded = 0, all = 0, elsewhere = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    BehaviourOptions options;
    options.seed = seed;
    options.rate = {100, 1};
    options.still.gaze = true;
    Behaviour behaviour = behaviour_of(options);
    // Ten seconds in which the other has nothing to say, then sentences of 3.1 s with pauses
    // of 1.4.
    std::vector<FaceMoment> moments;
    std::vector<double> ends;
    bool spoke = false;
    for (int i = 0; i < 30000; ++i) {
      const bool speaks = i >= 1000 && (i - 1000) % 450 < 310;
      behaviour.hear(speaks);
      if (spoke && !speaks) ends.push_back(0.01 * i);
      spoke = speaks;
      moments.push_back(behaviour.next());
    }
    const std::vector<double> nods = nods_of(moments);
    pauses += ends.size();
    all += nods.size();
    for (const double nod : nods) {
      const bool near = std::any_of(ends.begin(), ends.end(),
                                    [&](double end) { return nod > end - 0.1 && nod < end + 1; });
      (near ? nodded : elsewhere) += 1;
    }
  }
  EXPECT_GT(double(nodded), 0.5 * double(pauses)) << pauses << " pauses";
  EXPECT_LT(double(nodded), 0.95 * double(pauses));
  EXPECT_LT(double(elsewhere), 0.25 * double(all)) << "other motion of the head";
}

TEST(Behaviour, LooksAtTheOtherWhoSpeaks) {
  const auto contact = [](bool voice, Activity activity) {
    double share = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      BehaviourOptions options;
      options.seed = seed;
      Behaviour behaviour = behaviour_of(options);
      behaviour.set_activity(activity);
      for (int i = 0; i < 3000; ++i) {
        behaviour.hear(voice);
        const FaceMoment m = behaviour.next();
        const double yaw = 0.5 * (m.eye_yaw[0] + m.eye_yaw[1]) + m.head_yaw;
        const double pitch = 0.5 * (m.eye_pitch[0] + m.eye_pitch[1]) + m.head_pitch;
        share += std::hypot(yaw, pitch) * kDegrees < 3.5 ? 1.0 / 12000 : 0;
      }
    }
    return share;
  };
  for (const Activity activity : {Activity::idle, Activity::thinking, Activity::listening})
    EXPECT_GT(contact(true, activity), 0.85) << int(activity);
  EXPECT_LT(contact(false, Activity::idle), contact(true, Activity::idle));
  EXPECT_LT(contact(false, Activity::thinking), 0.5) << "the other is silent";
}

TEST(Behaviour, NeverHoldsTheEyesClosed) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    BehaviourOptions options;
    options.seed = seed;
    options.rate = {100, 1};
    options.liveliness = 2;
    Behaviour behaviour = behaviour_of(options);
    int shut = 0, longest = 0;
    for (int i = 0; i < 30000; ++i) {
      if (i % 500 == 0) behaviour.speak(plan_of(3));
      shut = behaviour.next().blink > 0.5 ? shut + 1 : 0;
      longest = std::max(longest, shut);
    }
    EXPECT_LT(longest, 30) << "0.3 s";
    EXPECT_GT(longest, 8);
  }
}

TEST(Behaviour, TheRateShowsTheSameFace) {
  BehaviourOptions slow, fast;
  fast.rate = {100, 1};
  Behaviour a = behaviour_of(slow), b = behaviour_of(fast);
  a.speak(plan_of(20));
  b.speak(plan_of(20));
  double off = 0, size = 0;
  for (int i = 0; i < 500; ++i) {
    const FaceMoment one = a.next(), other = b.next();
    for (int k = 0; k < 3; ++k) b.next();
    off += std::pow(one.head_yaw - other.head_yaw, 2);
    size += std::pow(one.head_yaw, 2);
  }
  EXPECT_LT(std::sqrt(off / size), 0.5);
}

TEST(Behaviour, ChecksItsOptions) {
  BehaviourOptions options;
  options.liveliness = 2.5;
  EXPECT_EQ(Behaviour::make(options).error().code, Code::invalid_argument);
  options.liveliness = -0.1;
  EXPECT_FALSE(Behaviour::make(options));
  EXPECT_EQ(parse_still("gaze,ears").error().code, Code::not_found);
  EXPECT_EQ(format_still(*parse_still("blinks,head")), "head,blinks");
}

TEST(Look, ReadsAndWritesTargets) {
  for (const char* text : {"camera", "away", "20,-5", "0.3,-0.1,0.8"})
    EXPECT_EQ(format_look(*parse_look(text)), text);
  EXPECT_EQ(format_look(*parse_look("+20, -5.50")), "20,-5.5");
  for (const char* text : {"", "up", "20", "20,", ",", "1,2,3,4", "1,x", "nan,0", "1e400,0"})
    EXPECT_EQ(parse_look(text).error().code, Code::syntax) << text;
  for (const char* text : {"61,0", "0,-41", "0,0,-1", "0,0,0", "5,0,1", "0,0,1001"})
    EXPECT_EQ(parse_look(text).error().code, Code::out_of_range) << text;
}

TEST(SpeechPlan, FindsPhrasesAndAccents) {
  const Script script{{{0, 0.5, "SIL", ""},
                       {0.5, 0.6, "AE", "at"},
                       {0.6, 1.0, "T", "at"},
                       {1.0, 1.3, "AY", "eye,"},
                       {1.3, 1.5, "T", "eye,"},
                       {1.5, 1.6, "SIL", ""},
                       {1.6, 1.7, "AE", "at"},
                       {1.7, 2.0, "T", "at?"},
                       {2.0, 3.0, "SIL", ""},
                       {3.0, 3.1, "AE", "at"},
                       {3.1, 3.5, "T", "at!"}}};
  const SpeechPlan plan = plan_speech(script);
  ASSERT_EQ(plan.phrases.size(), 3u);
  EXPECT_TRUE(plan.phrases[0].begins);
  EXPECT_FALSE(plan.phrases[0].ends);
  EXPECT_FALSE(plan.phrases[1].begins);
  EXPECT_TRUE(plan.phrases[1].ends);
  EXPECT_TRUE(plan.phrases[1].question);
  EXPECT_TRUE(plan.phrases[2].begins);
  EXPECT_TRUE(plan.phrases[2].exclaimed);
  ASSERT_EQ(plan.accents.size(), 3u) << "one a phrase";
  EXPECT_EQ(plan.accents[0].start, 1.0);
  EXPECT_TRUE(plan_speech({}).phrases.empty());
}

TEST(SpeechPlan, PitchMakesAccents) {
  // Six equal vowels; the pitch of the fourth rises by seven semitones.
  Script script;
  Prosody prosody;
  for (int i = 0; i < 6; ++i) {
    script.phones.push_back({0.5 * i, 0.5 * i + 0.3, "T", "word"});
    script.phones.push_back({0.5 * i + 0.3, 0.5 * i + 0.5, "EH", "word"});
  }
  for (int i = 0; i < 300; ++i) {
    const bool high = i >= 180 && i < 200;
    prosody.pitch.push_back(high ? 150.0f : 100.0f);
    prosody.level.push_back(0.1f);
  }
  const SpeechPlan plan = plan_speech(script, &prosody);
  ASSERT_FALSE(plan.accents.empty());
  double strongest = 0, at = 0;
  for (const SpeechAccent& accent : plan.accents) {
    if (accent.weight > strongest) at = accent.start;
    strongest = std::max(strongest, accent.weight);
    EXPECT_EQ(accent.rise, std::abs(accent.start - 1.8) < 0.01) << accent.start;
  }
  EXPECT_NEAR(at, 1.8, 0.01);
  EXPECT_NEAR(plan.pitch[190], 7.02, 0.05);
}

}  // namespace behaviour_test
}  // namespace animeme::dam
