#include "dam/performance/performance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "dam/model/builtin.h"
#include "dam/performance/over_speech.h"
#include "dam/performance/time_bend.h"
#include "dam/script/phones.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/fill.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace performance_test {

const Model& builtin() {
  static const Model model = *builtin_model();
  return model;
}

// Phrases of random sounds, with pauses between them.
Script talk(std::uint32_t seed, int phrases, double pace = 1) {
  std::vector<std::string> labels;
  for (const PhoneInfo& phone : dam::phones())
    if (phone.label != kSilence) labels.emplace_back(phone.label);
  for (const char* often : {"P", "B", "M", "F", "UW", "AA", "IY", "AE"}) labels.emplace_back(often);
  test::Uniform random(seed);
  Script script;
  double at = 0;
  const auto add = [&](const std::string& label, double seconds) {
    script.phones.push_back({at, at + seconds * pace, label, label == "SIL" ? "" : "word"});
    at += seconds * pace;
  };
  add("SIL", random(0.2, 0.6));
  for (int i = 0; i < phrases; ++i) {
    const auto count = 12 + random.below(16);
    for (std::size_t k = 0; k < count; ++k) {
      const double seconds = random(0.05, 0.16);
      add(labels[random.below(labels.size())], seconds);
    }
    add("SIL", random(0.3, 0.8));
  }
  return script;
}

Signal spoken(const Script& script, fap::Rate rate = {25, 1}) {
  SynthesisOptions options;
  options.rate = rate;
  options.articulation = std::nullopt;
  auto signal = synthesise(builtin(), script, options);
  EXPECT_TRUE(signal);
  return *signal;
}

// A face that says something and lives; `mood` is in it from begin to end.
fap::Sequence played(const Script& script, fap::Rate rate, std::uint64_t seed,
                     const Mood& mood = {}) {
  Signal signal = spoken(script, rate);
  IdleMotionOptions idle;
  idle.seed = seed;
  EXPECT_TRUE(add_idle_motion(signal, script, idle));
  EXPECT_TRUE(add_moods(signal, script, MoodTrack(mood)));
  fap::FillOptions fill;
  fill.expand = true;
  return *fap::fill(*to_sequence(signal), fill);
}

Performance performed(const Script& script, fap::Rate rate, std::uint64_t seed,
                      bool knows_script = true, const Mood& mood = {}) {
  auto made = Performance::make(played(script, rate, seed, mood), knows_script ? script : Script());
  EXPECT_TRUE(made);
  return *made;
}

fap::Mask upper_face() {
  fap::Mask mask;
  for (const char* region : {"brows", "lids", "gaze", "nose", "head"})
    mask |= *fap::region_faps(region);
  return mask;
}

double value(const fap::Sequence& clip, std::size_t frame, int fap) {
  return clip.frames[frame].value[std::size_t(fap)];
}

double largest_step(const fap::Sequence& clip, int fap) {
  double most = 0;
  for (std::size_t i = 1; i < clip.frames.size(); ++i)
    most = std::max(most, std::abs(value(clip, i, fap) - value(clip, i - 1, fap)));
  return most;
}

// In the time of one frame at another rate.
double largest_step(const fap::Sequence& clip, int fap, const fap::Rate& rate) {
  if (clip.rate == rate) return largest_step(clip, fap);
  return largest_step(clip, fap) * clip.rate.frames_per_second() / rate.frames_per_second();
}

std::size_t closures_missing(const fap::Sequence& clip, const Script& script) {
  const auto signal = *to_signal(clip);
  const auto lips = *inner_lip_channels(signal.names);
  std::size_t missing = 0;
  for (const Phone& phone : script.phones) {
    if (!is_bilabial(phone.label)) continue;
    const FrameSpan near = frames_near(signal, phone, kClosureSearch);
    double least = 1e9;
    for (std::size_t i = near.first; i < near.last; ++i)
      least = std::min(least, inner_gap(signal, i, lips));
    if (least >= kClosedGap) ++missing;
  }
  return missing;
}

void expect_legal(const BentTime& bent, const Performance& performance) {
  const auto& moments = bent.moments();
  ASSERT_GE(moments.size(), 2u);
  EXPECT_EQ(moments.front(), (BentMoment{0, 0}));
  for (std::size_t i = 1; i < moments.size(); ++i) {
    const double time = moments[i].time - moments[i - 1].time;
    const double source = moments[i].source - moments[i - 1].source;
    ASSERT_GT(time, 0);
    EXPECT_LE(source / time, 1 + kMostBend + 1e-6);
    EXPECT_GE(source / time, 1 / (1 + kMostBend) - 1e-6);
    const double middle = (moments[i].source + moments[i - 1].source) / 2;
    for (const OwnPace& one : performance.own_pace()) {
      if (middle <= one.start || middle >= one.end) continue;
      EXPECT_NEAR(source, time, 1e-6) << "a blink or a saccade changes its speed";
    }
  }
}

TEST(TimeBend, PhrasesMeetWithinTheLimits) {
  double before = 0, after = 0;
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    const Script own = talk(seed, 4), other = talk(100 + seed, 4, seed % 2 == 0 ? 1.1 : 0.92);
    const SpeechPlan from = plan_speech(own), to = plan_speech(other);
    const OwnPace fixed[] = {{1.0, 1.4}, {3.1, 3.5}, {5.02, 5.3}};
    BendOptions options;
    options.length = own.duration();
    options.wanted = other.duration();
    options.fixed = fixed;
    const BentTime bent = bend_time(from, to, options);
    for (std::size_t i = 1; i < bent.moments().size(); ++i) {
      const BentMoment a = bent.moments()[i - 1], b = bent.moments()[i];
      const double speed = (b.source - a.source) / (b.time - a.time);
      EXPECT_LE(speed, 1.25 + 1e-6);
      EXPECT_GE(speed, 0.8 - 1e-6);
      for (const OwnPace& one : fixed) {
        if (a.source >= one.end - 1e-9 || b.source <= one.start + 1e-9) continue;
        EXPECT_NEAR(speed, 1, 1e-6);
      }
    }
    const auto nearest = [&](double time, auto part) {
      double least = 1e9;
      for (const SpeechPhrase& phrase : from.phrases)
        least = std::min(least, std::abs(phrase.*part - time));
      return least;
    };
    for (const SpeechPhrase& phrase : to.phrases) {
      before += nearest(phrase.start, &SpeechPhrase::start);
      after += nearest(bent.source(phrase.start), &SpeechPhrase::start);
    }
  }
  EXPECT_LT(after, 0.6 * before);
}

TEST(TimeBend, TheSameSpeechKeepsItsTime) {
  const Script script = talk(7, 5);
  const SpeechPlan plan = plan_speech(script);
  BendOptions options;
  options.length = options.wanted = script.duration();
  const BentTime bent = bend_time(plan, plan, options);
  for (double time = 0; time < script.duration(); time += 0.13) EXPECT_EQ(bent.source(time), time);
}

TEST(TimeBend, OddLengths) {
  const SpeechPlan plan = plan_speech(talk(8, 3));
  for (const double own : {0.0, 0.01, 0.3, 8.0, 500.0}) {
    for (const double wanted : {0.0, 0.02, 1.0, 9.0, 700.0}) {
      for (const double most : {0.0, 0.05, 0.25}) {
        BendOptions options;
        options.length = own;
        options.wanted = wanted;
        options.most = most;
        options.rate = {30000, 1001};
        const BentTime bent = bend_time(plan, {}, options);
        double last = -1;
        for (double time = 0; time <= wanted; time += 0.5) {
          const double source = bent.source(time);
          EXPECT_TRUE(std::isfinite(source));
          EXPECT_GT(source, last);
          last = source;
        }
      }
    }
  }
}

TEST(OverSpeech, UpperFaceIsTheOriginals) {
  for (const std::uint32_t seed : {11u, 12u, 13u}) {
    for (const bool knows : {true, false}) {
      const Script own = talk(seed, 4), other = talk(seed + 50, 4, 1.08);
      const Performance performance = performed(own, {25, 1}, seed, knows);
      const fap::Sequence original = played(own, {25, 1}, seed);
      Signal signal = spoken(other);
      const fap::Sequence alone = *to_sequence(signal);
      Signal living = signal;
      ASSERT_TRUE(add_idle_motion(living, other));
      const fap::Sequence idle = *to_sequence(living);
      const auto report = speak_over(signal, other, performance);
      ASSERT_TRUE(report) << report.error().describe();
      expect_legal(report->time, performance);
      const fap::Sequence clip = *to_sequence(signal);
      std::size_t same = 0;
      for (std::size_t fap = 3; fap <= 68; ++fap) {
        if (!upper_face()[fap] || !performance.faps()[fap]) continue;
        const auto f = int(fap);
        double sum = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
        std::size_t count = 0, all = 0;
        for (std::size_t i = 0; i < clip.frames.size(); ++i) {
          const double at = report->time.source(clip.rate.seconds(double(i))) * 25;
          if (at > double(original.frames.size()) - 1) break;
          const auto frame = std::size_t(at + 1e-6);
          if (std::abs(at - double(frame)) < 1e-5) {
            const double away = value(clip, i, f) - value(original, frame, f);
            sum += away * away;
            ++count;
          }
          const double share = at - double(frame);
          const std::size_t next = std::min(frame + 1, original.frames.size() - 1);
          const double x = value(clip, i, f);
          const double y =
              (1 - share) * value(original, frame, f) + share * value(original, next, f);
          a += x, b += y, aa += x * x, bb += y * y, ab += x * y, ++all;
        }
        same = std::max(same, count);
        if (count > 0) {
          EXPECT_LT(std::sqrt(sum / double(count)), 1) << "FAP " << fap;
        }
        const double n = double(all);
        const double spread = std::sqrt((aa - a * a / n) * (bb - b * b / n));
        if (spread > n * 50) {
          EXPECT_GT((ab - a * b / n) / spread, 0.99) << "FAP " << fap;
        }
        // Whole units: a step of the sum of two that were rounded.
        EXPECT_LE(largest_step(clip, f),
                  1.05 * std::max(largest_step(original, f), largest_step(idle, f)) + 2)
            << "FAP " << fap;
      }
      EXPECT_GT(same, clip.frames.size() / 5);
      EXPECT_EQ(closures_missing(clip, other), 0u);
      for (const int fap : {3, 4, 5, 6, 7, 51, 52, 53, 54})
        EXPECT_LE(largest_step(clip, fap), 1.1 * largest_step(alone, fap) + 10) << "FAP " << fap;
    }
  }
}

TEST(OverSpeech, OtherRatesKeepBlinks) {
  const Script own = talk(21, 5), other = talk(71, 5);
  const fap::Rate from{30, 1}, to{25, 1};
  const fap::Sequence original = played(own, from, 3);
  const Performance performance = performed(own, from, 3);
  Signal signal = spoken(other, to);
  const auto report = speak_over(signal, other, performance);
  ASSERT_TRUE(report);
  const fap::Sequence clip = *to_sequence(signal);
  const auto closed = [](const fap::Frame& frame) { return frame.value[19] + frame.value[21]; };
  std::size_t blinks = 0;
  for (std::size_t i = 1; i + 1 < original.frames.size(); ++i) {
    const int here = closed(original.frames[i]);
    if (here < 900 || here < closed(original.frames[i - 1]) ||
        here < closed(original.frames[i + 1]))
      continue;
    int most = 0;
    for (std::size_t k = 0; k < clip.frames.size(); ++k) {
      const double source = report->time.source(to.seconds(double(k)));
      if (std::abs(source - from.seconds(double(i))) < 0.06)
        most = std::max(most, closed(clip.frames[k]));
    }
    if (report->time.source(to.seconds(double(clip.frames.size()))) < from.seconds(double(i) + 2))
      continue;
    EXPECT_GE(most, here - 2) << "the blink at " << from.seconds(double(i));
    ++blinks;
  }
  EXPECT_GT(blinks, 1u);
  for (const int fap : {19, 20, 23, 25, 31, 48, 49, 50})
    EXPECT_LE(largest_step(clip, fap), largest_step(original, fap, to) + 2) << fap;
}

TEST(OverSpeech, IdleMotionGoesOnWithoutAJump) {
  const Script own = talk(31, 1), other = talk(81, 6);
  const Performance performance = performed(own, {25, 1}, 5);
  Signal signal = spoken(other);
  Signal with_idle = signal;
  ASSERT_TRUE(add_idle_motion(with_idle, other));
  const auto report = speak_over(signal, other, performance);
  ASSERT_TRUE(report);
  EXPECT_LT(report->end, 0.6 * other.duration());
  const fap::Sequence clip = *to_sequence(signal), idle = *to_sequence(with_idle),
                      original = played(own, {25, 1}, 5);
  const auto end = std::size_t(report->end * 25);
  for (const int fap : {19, 20, 23, 24, 25, 26, 31, 33, 35, 48, 49, 50}) {
    const double most = std::max(largest_step(original, fap), largest_step(idle, fap));
    EXPECT_LE(largest_step(clip, fap), 1.5 * most + 2) << fap;
    // It moves, and in the end as idle motion does.
    EXPECT_EQ(value(clip, clip.frames.size() - 2, fap), value(idle, idle.frames.size() - 2, fap));
  }
  double moved = 0;
  for (std::size_t i = end + 1; i < clip.frames.size(); ++i)
    moved += std::abs(value(clip, i, 49) - value(clip, i - 1, 49));
  EXPECT_GT(moved, 100);

  // Without idle motion, the face comes to rest.
  Signal still = spoken(other);
  OverOptions none;
  none.idle.reset();
  ASSERT_TRUE(speak_over(still, other, performance, none));
  const fap::Sequence rests = *to_sequence(still);
  for (const int fap : {19, 25, 31, 49}) EXPECT_EQ(value(rests, rests.frames.size() - 1, fap), 0);
}

TEST(OverSpeech, GroupsThatRestAreFilled) {
  const Script own = talk(41, 3), other = talk(91, 3);
  fap::Sequence clip = played(own, {25, 1}, 5);
  for (fap::Frame& frame : clip.frames)
    for (const int fap : {48, 49, 50}) frame.value[std::size_t(fap)] = 0;
  const auto performance = Performance::make(clip, own);
  ASSERT_TRUE(performance);
  EXPECT_FALSE(performance->faps()[48]);
  EXPECT_TRUE(performance->faps()[31]);
  Signal signal = spoken(other), idle = signal;
  const auto report = speak_over(signal, other, *performance);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->filled[48] && !report->filled[31] && report->kept[31]);
  ASSERT_TRUE(add_idle_motion(idle, other));
  const fap::Sequence made = *to_sequence(signal), alone = *to_sequence(idle);
  for (std::size_t i = 0; i < made.frames.size(); ++i)
    EXPECT_EQ(value(made, i, 49), value(alone, i, 49));
}

TEST(OverSpeech, ASmileStaysAndLipsClose) {
  const Script own = talk(51, 4), other = talk(95, 4);
  const Performance smiling = performed(own, {25, 1}, 5, true, Mood{"joy", 0.8});
  const Performance neutral = performed(own, {25, 1}, 5);
  Signal plain = spoken(other), with = plain, without = plain, half = plain;
  ASSERT_TRUE(speak_over(with, other, smiling));
  ASSERT_TRUE(speak_over(without, other, neutral));
  OverOptions options;
  options.keep.set(*fap::region_faps("lips"), 0.5);
  ASSERT_TRUE(speak_over(half, other, smiling, options));
  const auto mean = [](const Signal& signal, int fap) {
    const fap::Sequence clip = *to_sequence(signal);
    double sum = 0;
    for (std::size_t i = 25; i + 25 < clip.frames.size(); ++i) sum += value(clip, i, fap);
    return sum / double(clip.frames.size() - 50);
  };
  // The corners go up as far as in the performance; half as far with half a share.
  const double up = mean(with, 12) - mean(without, 12);
  EXPECT_GT(up, 40);
  EXPECT_NEAR(mean(half, 12) - mean(plain, 12), (mean(with, 12) - mean(plain, 12)) / 2, 0.1 * up);
  EXPECT_LT(std::abs(mean(without, 12) - mean(plain, 12)), 0.3 * up);
  // What the original said does not stay.
  EXPECT_LT(std::abs(mean(without, 5) - mean(plain, 5)), 25);
  for (const Signal* signal : {&with, &without, &half})
    EXPECT_EQ(closures_missing(*to_sequence(*signal), other), 0u);
  // The rounding of the new sounds stays.
  for (std::size_t i = 0; i < plain.frames(); ++i) EXPECT_TRUE(std::isfinite(with.at(i, 0)));
}

TEST(OverSpeech, Errors) {
  EXPECT_EQ(Performance::make({}).error().code, Code::truncated);
  fap::Sequence one{{25, 1}, {fap::Frame()}, ""};
  EXPECT_EQ(Performance::make(one, {}, -1).error().code, Code::invalid_argument);
  one.rate = {0, 1};
  EXPECT_EQ(Performance::make(one).error().code, Code::invalid_argument);
  one.rate = {25, 1};
  const auto still = Performance::make(one);
  ASSERT_TRUE(still);
  const Script script = talk(1, 1);
  Signal signal = spoken(script);
  OverOptions options;
  options.bend = 0.5;
  EXPECT_EQ(speak_over(signal, script, *still, options).error().code, Code::invalid_argument);
  options.bend = 0.25;
  options.keep.of[31] = 2;
  EXPECT_EQ(speak_over(signal, script, *still, options).error().code, Code::invalid_argument);
  Signal rig;
  rig.names = {"left_knob"};
  rig.values = {1, 2, 3};
  EXPECT_EQ(speak_over(rig, script, *still).error().code, Code::unsupported);
  // One pose that rests: all is idle motion.
  const auto report = speak_over(signal, script, *still);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->kept.none());
  EXPECT_TRUE(report->filled[49]);
}

TEST(PerformanceLoop, RepeatsWithoutAJump) {
  const Script own = talk(61, 2);
  const fap::Sequence clip = played(own, {25, 1}, 5);
  auto performance = std::make_shared<const Performance>(*Performance::make(clip, own));
  PerformanceLoop loop(performance, KeptShares(), {25, 1});
  fap::Sequence shown{{25, 1}, {}, ""};
  const std::size_t length = clip.frames.size();
  for (std::size_t i = 0; i < 3 * length; ++i) {
    fap::Frame frame;
    loop.next({}, frame);
    EXPECT_EQ(frame.mask & loop.faps(), loop.faps());
    shown.frames.push_back(frame);
  }
  for (const int fap : {19, 23, 25, 31, 48, 49, 50}) {
    for (std::size_t i = 0; i < length; ++i)
      EXPECT_EQ(value(shown, i, fap), value(clip, i, fap)) << "FAP " << fap << " frame " << i;
    EXPECT_LE(largest_step(shown, fap), 1.5 * largest_step(clip, fap) + 2) << fap;
    // The second round is the first one again, once the joint has faded.
    EXPECT_EQ(value(shown, 2 * length - 1, fap), value(clip, length - 1, fap));
  }
}

}  // namespace performance_test
}  // namespace animeme::dam
