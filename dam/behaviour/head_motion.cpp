#include <algorithm>
#include <cmath>
#include <limits>

#include "dam/behaviour/head_motion_internal.h"

namespace animeme::dam::behaviour {
namespace {

// Share of motion of each mode, of that when speaking (Hadar and others 1983: little while
// listening), and seconds between shifts of posture.
constexpr double kShare[] = {0.4, 0.4, 0.5, 1};
constexpr double kShiftMean[] = {4.5, 5, 3, 2.2}, kShiftDeviation[] = {3, 3, 1.5, 1.4};

// Standard deviations in degrees: pitch, yaw, roll.
constexpr double kPosture[] = {2.3, 2.4, 1.2};  // below 1.8 Hz, with
constexpr double kSlow[] = {0.9, 1.0, 0.5};     // this
constexpr double kOrdinary[] = {0.2, 0.18, 0.1};
constexpr double kRapid[] = {0.05, 0.045, 0.02};
constexpr double kOrdinaryHertz = 2.7, kRapidHertz = 4.8;

constexpr double kPostureSeconds = 0.16;  // time constant, twice in a row: a second in all

// Time constant of a turn: larger ones are quicker, and take longer.
constexpr double kTurn = 0.1, kTurnPerDegree = 0.0025;

constexpr double kNoNod = std::numeric_limits<double>::infinity();
// Of a listener who hears the other: pauses with a nod, and seconds between two groups of nods.
constexpr double kNodAtPause = 0.75, kNodsApart = 1.0;

constexpr double kOfPitch = 0.55, kOfTrend = 0.05;  // degrees a semitone
constexpr double kMostSemitones = 7;

/// A gesture of the head that lies about `middle`.
Gesture<3> beat(double middle, double seconds, double early, const HeadPose& amount) {
  Gesture<3> g;
  g.onset = middle - early * seconds;
  g.apex = g.release = middle;
  g.end = middle + (1 - early) * seconds;
  g.amount = {amount.pitch, amount.yaw, amount.roll};
  return g;
}

// What is told late begins now and takes at least as long as people take.
void not_before(double now, double least, Gesture<3>& g) {
  if (g.onset >= now) return;
  g.onset = now;
  g.apex = std::max(g.apex, now + least);
  g.release = std::max(g.release, g.apex);
  g.end = std::max(g.end, g.release + least);
}

}  // namespace

HeadMotion::HeadMotion(std::uint64_t seed)
    : draw_(mixed(seed, 31)),
      slow_{{mixed(seed, 32), 0.7}, {mixed(seed, 33), 0.8}, {mixed(seed, 34), 0.9}},
      ordinary_{{mixed(seed, 35), kOrdinaryHertz, 0.6},
                {mixed(seed, 36), kOrdinaryHertz, 0.6},
                {mixed(seed, 37), kOrdinaryHertz, 0.6}},
      rapid_{{mixed(seed, 38), kRapidHertz, 0.4},
             {mixed(seed, 39), kRapidHertz, 0.4},
             {mixed(seed, 40), kRapidHertz, 0.4}} {
  amplitude_.value = kShare[0];
  next_shift_ = draw_.between(0.3, 2.5);
  next_nod_ = draw_.between(2, 5);
  next_breath_ = draw_.between(0, 3);
  for (double& lean : lean_) lean = draw_.between(-0.12, 0.12);
}

void HeadMotion::nod(const SpeechAccent& accent, double start, double now) {
  const double weight = accent.weight;
  // Drawn also where nothing comes of it: a later accent must not depend on it.
  const double kind = draw_.between(0, 1), size = std::max(0.4, 1 + 0.3 * draw_.normal());
  const double seconds = draw_.between(0.4, 0.7), side = draw_.chance(0.5) ? 1 : -1;
  const double middle = start + 0.5 * (accent.start + accent.end) + draw_.between(-0.03, 0.05);
  if (middle < now || kind > 0.35 + 0.45 * weight) return;
  HeadPose amount{size * (1.0 + 1.9 * weight), 0, 0};
  if (kind < 0.08)
    amount = {0.4 * amount.pitch, side * 0.9 * amount.pitch, -side * 0.3};
  else if (kind < 0.14)
    amount = {-0.6 * amount.pitch, 0, side * 0.4 * amount.pitch};
  Gesture<3> gesture = beat(middle, seconds, 0.42, amount);
  not_before(now, 0.15, gesture);
  // A small move the other way comes first.
  Gesture<3> before =
      beat(gesture.onset + 0.05, 0.36, 0.5, {-0.22 * amount.pitch, -0.15 * amount.yaw, 0});
  if (before.onset >= now) gestures_.add(before);
  gestures_.add(gesture);
  ++nods_;
}

void HeadMotion::end_phrase(const SpeechPhrase& phrase, double start, double now) {
  const double end = start + phrase.end, side = draw_.chance(0.5) ? 1 : -1;
  const double size = std::max(0.5, 1 + 0.25 * draw_.normal());
  Gesture<3> g;
  g.ending = true;
  if (phrase.question) {
    g.onset = std::max(start + phrase.start, end - 0.7);
    g.apex = end - 0.1;
    g.release = end + 0.5;
    g.end = end + 1.3;
    g.amount = {-2.2 * size, side * 0.6 * size, side * 3.4 * size};
  } else if (phrase.ends) {  // it settles
    g.onset = end - 0.35;
    g.apex = end + 0.25;
    g.release = end + 0.5;
    g.end = end + 1.5;
    g.amount = {1.5 * size, 0, side * 0.5};
  } else {
    return;
  }
  if (end < now) return;
  not_before(now, 0.3, g);
  gestures_.add(g);
}

void HeadMotion::speak(const SpeechPlan& plan, double start, double now) {
  for (const SpeechAccent& accent : plan.accents) nod(accent, start, now);
  for (const SpeechPhrase& phrase : plan.phrases) {
    end_phrase(phrase, start, now);
    if (start + phrase.start < now - 0.2) continue;
    begins_.push_back(start + phrase.start);
    inhales_.push_back(start + phrase.start - draw_.between(0.25, 0.45));
  }
  if (!plan.pitch.empty()) voices_.push_back({start, plan.step, plan.pitch, plan.level});
}

void HeadMotion::go_on(double now) {
  gestures_.drop_from(now, [](const Gesture<3>& g) { return g.ending; });
}

void HeadMotion::hush(double now) {
  gestures_.drop_from(now, [](const Gesture<3>&) { return true; });
  begins_.clear();
  inhales_.clear();
  voices_.clear();
}

void HeadMotion::shift_posture(double time, Mode mode, double share) {
  const auto goal = [&](double before, double deviation) {
    return share * (0.25 * before + 0.97 * deviation * draw_.normal());
  };
  goal_ = {goal(goal_.pitch, kPosture[0]), goal(goal_.yaw, kPosture[1]),
           goal(goal_.roll, kPosture[2])};
  last_shift_ = time;
  const std::size_t m = std::size_t(mode);
  next_shift_ = time + std::max(0.6, draw_.skewed(kShiftMean[m], kShiftDeviation[m]));
}

// One to three nods, each smaller.
void HeadMotion::backchannel(double time) {
  const std::size_t nods = 1 + draw_.below(3);
  double middle = time + 0.2, size = draw_.between(1.8, 3.2);
  for (std::size_t i = 0; i < nods; ++i, size *= 0.7) {
    const double seconds = draw_.between(0.35, 0.5);
    gestures_.add(beat(middle, seconds, 0.45, {size, 0, 0}));
    middle += seconds;
  }
  last_nod_ = middle;
  next_nod_ = hears_ ? kNoNod : time + 1.5 + draw_.exponential(4.5, 15);
}

void HeadMotion::nod_at_pauses_only() {
  if (!hears_) next_nod_ = kNoNod;
  hears_ = true;
}

bool HeadMotion::pause_of_other(double now) {
  const double delay = draw_.between(0, 0.25);
  if (now < last_nod_ + kNodsApart || !draw_.chance(kNodAtPause)) return false;
  next_nod_ = now + delay;
  return true;
}

void HeadMotion::breathe(double time, double seconds, Mode mode) {
  if (mode == Mode::speaking) {
    while (!inhales_.empty() && inhales_.front() <= time) {
      // Short in, long out.
      if (time >= next_breath_) {
        inhale_until_ = time + 0.4;
        quick_ = 0.4;
        next_breath_ = time + 1.6;
      }
      inhales_.pop_front();
    }
  } else {
    while (!inhales_.empty() && inhales_.front() <= time - 0.5) inhales_.pop_front();
    if (time >= next_breath_) {  // 12 to 18 a minute
      inhale_until_ = time + 1.3;
      quick_ = 1;
      next_breath_ = time + draw_.between(3.4, 5);
    }
  }
  const bool in = time < inhale_until_;
  breath_.follow(in ? 1 : 0, seconds, in ? 0.4 * quick_ : mode == Mode::speaking ? 0.8 : 0.55);
}

void HeadMotion::follow_voice(double time, double seconds) {
  while (!voices_.empty() && voices_.front().end() < time) voices_.pop_front();
  double pitch = 0, level = 0.5;
  const double ahead = time + 0.04;  // what follows it lags behind
  if (!voices_.empty() && voices_.front().start <= ahead) {
    const Contour& voice = voices_.front();
    const auto at =
        std::min(std::size_t((ahead - voice.start) / voice.step), voice.pitch.size() - 1);
    pitch = std::clamp(double(voice.pitch[at]), -kMostSemitones, kMostSemitones);
    level = double(voice.level[at]);
    if (level < 0.05) pitch = voice_trend_.value;  // a pause
  }
  voice_.follow(pitch, seconds, 0.05);
  voice_trend_.follow(pitch, seconds, 0.6);
  loudness_.follow(voices_.empty() ? 0 : level - 0.5, seconds, 0.15);
}

void HeadMotion::follow_eyes(const Aim& goal, double time) {
  turn_next_ = goal;
  turn_at_ = time + draw_.between(0.02, 0.1);
}

HeadPose HeadMotion::at(double time, double seconds, Mode mode) {
  if (mode != mode_) {
    mode_ = mode;
    next_shift_ = std::min(next_shift_, time + draw_.between(0.3, 1.5));
    const double later = time + draw_.between(1, 4);
    if (!hears_)
      next_nod_ = std::max(next_nod_, later);
    else if (mode != Mode::listening)
      next_nod_ = kNoNod;
  }
  const std::size_t m = std::size_t(mode);
  while (!begins_.empty() && begins_.front() <= time) {
    if (time - last_shift_ > 0.9 && draw_.chance(0.7)) next_shift_ = time;
    begins_.pop_front();
  }
  const double share = amplitude_.follow(kShare[m], seconds, 0.3);
  if (time >= next_shift_) shift_posture(time, mode, kShare[m]);
  if (mode == Mode::listening && time >= next_nod_) backchannel(time);
  breathe(time, seconds, mode);
  follow_voice(time, seconds);
  if (turn_at_ >= 0 && time >= turn_at_) {
    turn_goal_ = turn_next_;
    turn_at_ = -1;
    const double far =
        std::hypot(turn_goal_.yaw - turn_yaw_.value, turn_goal_.pitch - turn_pitch_.value);
    turn_seconds_ = kTurn + kTurnPerDegree * far;
  }
  turn_pitch_.follow(turn_goal_.pitch, seconds, turn_seconds_);
  turn_yaw_.follow(turn_goal_.yaw, seconds, turn_seconds_);

  const double goals[] = {goal_.pitch, goal_.yaw, goal_.roll};
  const auto gestures = gestures_.at(time);
  const double lively = share * (1 + 0.6 * loudness_.value);
  double pose[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    posture_of_[axis].follow(goals[axis], seconds, kPostureSeconds);
    posture_[axis].follow(posture_of_[axis].value, seconds, kPostureSeconds);
    pose[axis] =
        posture_[axis].value + gestures[axis] + share * kSlow[axis] * slow_[axis].at(time) +
        lively *
            (kOrdinary[axis] * ordinary_[axis].at(time) + kRapid[axis] * rapid_[axis].at(time));
  }
  // Accents of the voice are beats down, and the head sinks with the voice in the course of a
  // phrase.
  const double local = voice_.value - voice_trend_.value;
  pose[0] += kOfPitch * local - kOfTrend * voice_trend_.value - 0.5 * breath_.value;
  pose[1] += lean_[0] * local;
  pose[2] += lean_[1] * local;
  return {pose[0], pose[1], pose[2]};
}

}  // namespace animeme::dam::behaviour
