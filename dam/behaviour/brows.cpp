#include <algorithm>
#include <cmath>
#include <limits>

#include "dam/behaviour/brows_internal.h"

namespace animeme::dam::behaviour {
namespace {

// Probability of a raise at an accent to which the pitch rises, and at another: seven of ten go
// with a rise (Cavé and others 1996).
constexpr double kAtRise = 0.4, kElsewhere = 0.33, kFrown = 0.12;
constexpr double kRaiseApart = 0.8;         // seconds between two raises
constexpr double kMost = 110, kReach = 30;  // where a brow gets stiff, and how far it still goes
constexpr double kSide = 0.14;              // standard deviation of a side from the other

double softened(double units) {
  const double beyond = std::abs(units) - kMost;
  if (beyond <= 0) return units;
  return std::copysign(kMost + kReach * std::tanh(beyond / kReach), units);
}

}  // namespace

Brows::Brows(std::uint64_t seed, bool questions_only)
    : draw_(mixed(seed, 51)), questions_only_(questions_only) {
  next_ = draw_.between(3, 9);
}

void Brows::raise(One& g, double size) {
  const double left = size * std::clamp(1 + kSide * draw_.normal(), 0.7, 1.3);
  const double right = size * std::clamp(1 + kSide * draw_.normal(), 0.7, 1.3);
  // Inner and outer ends have muscles of their own.
  const double inner = draw_.between(0.65, 1.05), outer = draw_.between(0.5, 0.95);
  g.amount = {inner * left, inner * right, left, right, outer * left, outer * right, 0, 0};
}

void Brows::frown(One& g, double size) {
  const double side = 1 + 0.5 * kSide * draw_.normal();
  g.amount = {-size * side, -size / side, -0.7 * size, -0.7 * size,
              -0.2 * size,  -0.2 * size,  1.2 * size,  0.4 * size};
}

void Brows::accent(const SpeechAccent& accent, double start, double now) {
  const double kind = draw_.between(0, 1);
  const double size = std::clamp(1 + 0.25 * draw_.normal(), 0.5, 1.4);
  const double rise = draw_.between(0.18, 0.28), hold = draw_.between(0, 0.2);
  const double fall = draw_.between(0.25, 0.45);
  const double apex = start + 0.5 * (accent.start + accent.end) + draw_.between(-0.04, 0.04);
  if (apex < now || apex - last_apex_ < kRaiseApart) return;
  const double raises = (accent.rise ? kAtRise : kElsewhere) * (accent.weight > 0.45 ? 1 : 0.6);
  if (kind > raises + kFrown * accent.weight) return;
  One g;
  g.onset = apex - rise;
  g.apex = apex;
  if (g.onset < now) {
    g.onset = now;
    g.apex = std::max(apex, now + 0.2);
  }
  g.release = g.apex + hold;
  g.end = g.release + fall;
  if (kind <= raises) {
    raise(g, (42 + 48 * accent.weight) * size);
    ++raises_;
  } else {
    frown(g, 34 * size);
  }
  last_apex_ = g.apex;
  gestures_.add(g);
}

void Brows::question(const SpeechPhrase& phrase, double start, double now) {
  const double size = draw_.between(60, 105), after = draw_.between(0.15, 0.5);
  const double end = start + phrase.end;
  if (end < now) return;
  One g;
  g.ending = true;
  g.onset = std::max({now, start + phrase.start, end - 0.75});
  g.apex = std::max(g.onset + 0.28, end - 0.4);
  g.release = std::max(g.apex, end + after);
  g.end = g.release + draw_.between(0.4, 0.6);
  raise(g, size);
  last_apex_ = std::max(last_apex_, g.apex);
  gestures_.add(g);
}

void Brows::speak(const SpeechPlan& plan, double start, double now) {
  auto phrase = plan.phrases.begin();
  const auto finish = [&](double before) {
    for (; phrase != plan.phrases.end() && phrase->end <= before; ++phrase)
      if (phrase->question) question(*phrase, start, now);
  };
  for (const SpeechAccent& one : plan.accents) {
    finish(one.start);
    // The end of a question is raised as a whole.
    const bool late =
        phrase != plan.phrases.end() && phrase->question && one.end > phrase->end - 0.9;
    if (!late && !questions_only_) accent(one, start, now);
  }
  finish(std::numeric_limits<double>::infinity());
}

void Brows::go_on(double now) {
  gestures_.drop_from(now, [](const One& g) { return g.ending; });
}

void Brows::hush(double now) {
  gestures_.drop_from(now, [](const One&) { return true; });
  last_apex_ = std::min(last_apex_, now);
}

void Brows::by_itself(double time, Mode mode) {
  One g;
  g.onset = time;
  g.apex = time + draw_.between(0.25, 0.4);
  if (mode == Mode::thinking) {
    g.release = g.apex + draw_.between(0.8, 2);
    if (draw_.chance(0.6))
      frown(g, draw_.between(22, 42));
    else
      raise(g, draw_.between(30, 55));
    next_ = time + 3 + draw_.exponential(2, 6);
  } else {
    g.release = g.apex + draw_.between(0.1, 0.6);
    const bool listens = mode == Mode::listening;
    raise(g, listens ? draw_.between(35, 70) : draw_.between(18, 40));
    next_ = time + 2 + draw_.exponential(listens ? 5 : 10, 30);
  }
  g.end = g.release + draw_.between(0.4, 0.7);
  gestures_.add(g);
}

BrowPose Brows::at(double time, Mode mode) {
  if (mode != mode_) {
    mode_ = mode;
    if (mode == Mode::thinking) next_ = time + draw_.between(0.1, 0.5);
    if (mode != Mode::speaking) next_ = std::max(next_, time + draw_.between(0.1, 0.5));
  }
  if (mode != Mode::speaking && time >= next_ && !questions_only_) by_itself(time, mode);
  auto sum = gestures_.at(time);
  for (double& one : sum) one = softened(one);
  BrowPose pose;
  for (std::size_t side = 0; side < 2; ++side) {
    pose.inner[side] = sum[side];
    pose.middle[side] = sum[2 + side];
    pose.outer[side] = sum[4 + side];
    pose.squeeze[side] = sum[6];
  }
  pose.cheek = sum[7];
  return pose;
}

}  // namespace animeme::dam::behaviour
