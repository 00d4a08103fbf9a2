#include <algorithm>
#include <cmath>

#include "dam/behaviour/blinks_internal.h"

namespace animeme::dam::behaviour {
namespace {

// A minute: idle, listening (the other is looked at: fewer), thinking, speaking. Bentivoglio and
// others 1997 have 17 at rest and 26 in conversation; phrases and gaze shifts bring some of these.
constexpr double kPerMinute[] = {17, 14, 18, 19.5};
// Coefficient of variation of the intervals, likewise. Borders and shifts even out those of speech.
constexpr double kVariation[] = {1, 1, 1, 1.7};
constexpr double kDouble = 0.08, kLongest = 18;

constexpr double kHalf = 0.18;     // share of blinks that do not close the eye
constexpr double kBetween = 0.06;  // seconds with open eyes between the two of a pair, at least
constexpr double kApart = 0.4;     // likewise between others

// Where a blink that is due moves to: a border within these seconds, with this probability.
constexpr double kBefore = 1.1, kBehind = 0.6, kAtBorder = 0.7;
constexpr double kLargeShift = 12, kWithShift = 0.6, kSoon = 1.5;  // degrees; seconds

}  // namespace

Blinks::Blinks(std::uint64_t seed, double liveliness, double end, double frame)
    : draw_(mixed(seed, 21)), liveliness_(liveliness), end_(end), frame_(frame) {
  // As if one had looked at it by chance in the middle of an interval.
  const double share = draw_.between(0.1, 1);  // apart: the order of draws decides their values
  clock_ = next_ = std::max(0.4, interval(mode_) * share);
  blink_.start = -10;
}

double Blinks::interval(Mode mode) {
  const double a_minute = kPerMinute[std::size_t(mode)] * (0.5 + 0.5 * liveliness_);
  const double mean = (1 + kDouble) * 60 / a_minute;
  return std::min(draw_.skewed(mean, kVariation[std::size_t(mode)] * mean), kLongest);
}

// Moves the next blink to a border nearby.
void Blinks::attract() {
  for (const double border : borders_) {
    if (border < next_ - kBefore) continue;
    if (border > next_ + kBehind) return;
    if (draw_.chance(kAtBorder)) next_ = border + draw_.between(-0.05, 0.2);
    return;
  }
}

void Blinks::expect_border(double time, double now) {
  if (time < now) return;
  borders_.insert(std::upper_bound(borders_.begin(), borders_.end(), time), time);
  const bool near = time >= next_ - kBefore && time <= next_ + kBehind;
  if (near && draw_.chance(kAtBorder)) next_ = std::max(now, time + draw_.between(-0.05, 0.2));
}

void Blinks::hush(double now) {
  while (!borders_.empty() && borders_.back() >= now) borders_.pop_back();
}

void Blinks::shift(double time, double size) {
  if (size < kLargeShift || next_ > time + kSoon || !draw_.chance(kWithShift)) return;
  next_ = time;
}

void Blinks::begin(double time) {
  ++count_;
  Blink blink;
  blink.depth = draw_.chance(kHalf) ? draw_.between(0.35, 0.75) : 1;
  blink.down = draw_.between(0.06, 0.11) * (0.7 + 0.3 * blink.depth);
  blink.shut = draw_.between(0, 0.05);
  blink.up = draw_.between(0.15, 0.28) * (0.6 + 0.4 * blink.depth);
  // Lids that meet between two moments would not be seen to meet.
  const double closed = std::ceil((time + blink.down) / frame_ - 1e-6) * frame_;
  blink.start = closed - blink.down;
  blink_ = blink;
  if (!doubled_ && draw_.chance(kDouble)) {
    doubled_ = true;
    next_ = blink.end() + draw_.between(kBetween, 0.2);
    return;
  }
  doubled_ = false;
  clock_ = std::max(clock_, blink.start - 3) + interval(mode_);
  next_ = std::max(clock_, blink.end() + kApart);
  attract();
  next_ = std::max(next_, blink.end() + kApart);
}

void Blinks::advance(double now, double until, Mode mode) {
  if (mode != mode_) {
    mode_ = mode;
    // People who begin to speak blink more, at once: the rest of the interval is drawn again.
    if (next_ > now + 1) {
      const double share = draw_.between(0, 1);
      clock_ = next_ = now + 0.5 + interval(mode) * share;
    }
    attract();
  }
  next_ = std::max(next_, blink_.end() + kBetween);
  while (!borders_.empty() && borders_.front() < now - 1) borders_.pop_front();
  if (next_ < until && std::max(next_, now) + 0.6 < end_) begin(std::max(next_, now));
}

double Blinks::at(double time) const {
  const double t = time - blink_.start;
  if (t <= 0 || time >= blink_.end()) return 0;
  if (t < blink_.down) return blink_.depth * smooth_step(t / blink_.down);
  if (t <= blink_.down + blink_.shut + 1e-9) return blink_.depth;
  // Opening slows down towards its end.
  const double x = (t - blink_.down - blink_.shut) / blink_.up;
  const double left = 1 - x;
  return blink_.depth * left * left * (1 + 2 * x);
}

}  // namespace animeme::dam::behaviour
