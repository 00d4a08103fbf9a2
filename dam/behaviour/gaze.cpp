#include <algorithm>
#include <cmath>

#include "dam/behaviour/gaze_internal.h"

namespace animeme::dam::behaviour {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Mean and standard deviation in seconds.
struct Seconds {
  double mean, deviation;
};
// Talking and listening are those of Lee, Badler, Badler 2002 (talking 3.1 and 0.93 s) as measured
// in what is shown, where begins and ends of utterances cut some short. Idle lies between them; a
// thinking person hardly looks at the other.
constexpr Seconds kAt[] = {{4.5, 3.5}, {7.9, 1.6}, {0.7, 0.4}, {4.0, 4.2}};
constexpr Seconds kAway[] = {{1.0, 0.7}, {0.43, 0.24}, {2.4, 1.6}, {1.35, 1.2}};
constexpr double kLeastAt = 0.3, kLeastAway = 0.15;

// Sizes, likewise: exponential, cut off. What is smaller than kOnTheFace goes from eye to eye and
// to the mouth of the other.
constexpr double kMeanSize = 6.9, kMostTalking = 27.5, kMostListening = 22.7, kOnTheFace = 2;
// Eight directions from right counter-clockwise, percent.
constexpr double kDirections[] = {15.5, 6.5, 17.7, 7.4, 16.8, 7.9, 20.4, 7.8};
constexpr double kMostWithinAway = 18;          // degrees from one look away to another
constexpr double kMostUp = 15, kMostDown = 20;  // degrees that look like people

constexpr double kLatency = 0.025, kPerDegree = 0.0024;  // seconds of a saccade
constexpr double kFixation = 0.12;                       // seconds between two saccades, at least
constexpr Seconds kScan[] = {{3.5, 2.5}, {4.5, 3}, {2, 1}, {1.5, 1}};
constexpr double kMicroEvery = 0.8, kMicro = 0.2, kDrift = 0.05;  // seconds, degrees

constexpr double kViewerNear = 1 / 1.2, kElsewhereNear = 0.5;  // 1 / metres

// At begins of utterances and in pauses.
constexpr double kPlans = 0.7, kHesitates = 0.35;

// Share of the head in gaze shifts: of glances beyond some 15 degrees, and more of lasting ones.
constexpr double kGlanceShare = 0.55, kLastingShare = 0.6;
constexpr double kEyeYaw = 35, kEyeUp = 25, kEyeDown = 32, kComfort = 25;  // degrees in the head
constexpr double kHalfEyes = 0.0315;                                       // metres

double share_of_glance(double degrees) { return kGlanceShare * smooth_step((degrees - 11) / 8); }

// A lasting goal: small angles are looked at with the eyes.
double lasting(double angle) {
  const double size = std::abs(angle);
  const double turned = size * kLastingShare * smooth_step((size - 2) / 14);
  return std::copysign(std::max(turned, size - kComfort), angle);
}

}  // namespace

Gaze::Gaze(std::uint64_t seed, double liveliness, double end, const Look& look)
    : draw_(mixed(seed, 11)),
      liveliness_(std::max(liveliness, 0.05)),
      end_(end),
      drift_yaw_(mixed(seed, 12), 0.4),
      drift_pitch_(mixed(seed, 13), 0.4) {
  set_base(look);
  from_ = to_ = base_;
  mode_end_ = 0.4 + at_seconds(Mode::idle);
  next_scan_ = scan_seconds();
  next_micro_ = draw_.between(0.3, 1);
  if (averted_) {
    away_ = true;
    offset_ = away_offset(mode_);
    to_ = from_ = {base_.yaw + offset_.yaw, base_.pitch + offset_.pitch, kElsewhereNear};
    mode_end_ = away_seconds(mode_);
  }
}

void Gaze::set_base(const Look& target) {
  averted_ = target.kind == Look::Kind::away;
  switch (target.kind) {
    case Look::Kind::camera:
      base_ = {0, 0, kViewerNear};
      return;
    case Look::Kind::away:
      base_ = {0, 0, kElsewhereNear};
      return;
    case Look::Kind::direction:
      base_ = {target.yaw, -target.pitch, kElsewhereNear};
      return;
    case Look::Kind::point: {
      const double flat = std::hypot(target.x, target.z);
      base_ = {std::atan2(target.x, target.z) / kRadians, -std::atan2(target.y, flat) / kRadians,
               1 / std::hypot(flat, target.y)};
      return;
    }
  }
}

double Gaze::at_seconds(Mode mode) {
  const Seconds s = kAt[std::size_t(mode)];
  return std::max(kLeastAt, draw_.skewed(s.mean, s.deviation) / liveliness_);
}

double Gaze::away_seconds(Mode mode) {
  if (averted_) return std::max(0.5, draw_.skewed(1.8, 1.0));
  const Seconds s = kAway[std::size_t(mode)];
  return std::max(kLeastAway, draw_.skewed(s.mean, s.deviation));
}

double Gaze::scan_seconds() {
  const Seconds s = kScan[std::size_t(mode_)];
  return std::max(0.4, draw_.skewed(s.mean, s.deviation));
}

Gaze::Offset Gaze::away_offset(Mode mode) {
  const double most = mode == Mode::speaking ? kMostTalking : kMostListening;
  double least = kOnTheFace;
  if (averted_ || mode == Mode::thinking) least = 7;
  const double size = least + draw_.exponential(kMeanSize, most - least);
  Offset offset;
  for (int tries = 0; tries < 6; ++tries) {
    double left = 0;
    for (const double percent : kDirections) left += percent;
    left = draw_.between(0, left);
    std::size_t bin = 0;
    while (bin + 1 < std::size(kDirections) && left >= kDirections[bin]) left -= kDirections[bin++];
    // People who think look up or aside, not down.
    if (mode == Mode::thinking && bin >= 5) bin = 8 - bin;
    const double angle = (double(bin) + draw_.between(-0.5, 0.5)) * std::numbers::pi / 4;
    // Right is the right of the person, where yaw is negative.
    offset = {-size * std::cos(angle), -size * std::sin(angle)};
    if (-offset.pitch <= kMostUp && offset.pitch <= kMostDown) return offset;
  }
  offset.pitch = std::clamp(offset.pitch, -kMostUp, kMostDown);
  return offset;
}

void Gaze::saccade(double time, const Offset& to, double nearness) {
  from_ = at(time);
  from_.yaw -= micro_.yaw + kDrift * drift_yaw_.at(time);
  from_.pitch -= micro_.pitch + kDrift * drift_pitch_.at(time);
  offset_ = to;
  to_ = {base_.yaw + to.yaw, base_.pitch + to.pitch, nearness};
  size_ = std::hypot(to_.yaw - from_.yaw, to_.pitch - from_.pitch);
  start_ = time;
  duration_ = kLatency + kPerDegree * size_;
  // The velocity has its peak the earlier the larger the saccade is.
  skew_ = 1 - 0.2 * std::min(1.0, size_ / 15);
}

Aim Gaze::at(double time) {
  double done = 1;
  if (duration_ > 0 && time < start_ + duration_) {
    const double s = std::pow(std::clamp((time - start_) / duration_, 0.0, 1.0), skew_);
    done = 0.5 * (1 - std::cos(std::numbers::pi * s));
  }
  const auto between = [&](double a, double b) { return a + done * (b - a); };
  return {between(from_.yaw, to_.yaw) + micro_.yaw + kDrift * drift_yaw_.at(time),
          between(from_.pitch, to_.pitch) + micro_.pitch + kDrift * drift_pitch_.at(time),
          between(from_.nearness, to_.nearness)};
}

Aim Gaze::head_goal() const {
  const double share = share_of_glance(std::hypot(offset_.yaw, offset_.pitch));
  return {lasting(base_.yaw) + share * offset_.yaw, lasting(base_.pitch) + share * offset_.pitch,
          0};
}

void Gaze::go_away(double time, double seconds, Mode mode) {
  away_ = true;
  saccade(time, away_offset(mode), kElsewhereNear);
  mode_end_ = time + seconds;
  // Long looks away have another fixation in between.
  next_scan_ = seconds > 1.3 ? time + seconds * draw_.between(0.4, 0.7) : kNever;
}

void Gaze::come_back(double time, Mode mode) {
  away_ = false;
  saccade(time, {draw_.between(-0.6, 0.6), draw_.between(-0.4, 0.4)}, base_.nearness);
  mode_end_ = time + at_seconds(mode);
  next_scan_ = time + scan_seconds();
}

void Gaze::scan(double time) {
  if (away_) {
    Offset to = away_offset(mode_);
    const double most = averted_ ? kMostTalking : kMostWithinAway;
    for (int tries = 0; tries < 5; ++tries) {
      if (std::hypot(to.yaw - offset_.yaw, to.pitch - offset_.pitch) <= most) break;
      to = away_offset(mode_);
    }
    saccade(time, to, kElsewhereNear);
    next_scan_ = kNever;
    return;
  }
  // The eyes and the mouth of the other, in turn.
  static constexpr Offset kPlaces[] = {{0.8, -0.1}, {-0.8, -0.1}, {0, 0.9}};
  const Offset place = kPlaces[draw_.below(std::size(kPlaces))];
  saccade(time, {place.yaw + draw_.between(-0.4, 0.4), place.pitch + draw_.between(-0.4, 0.4)},
          base_.nearness);
  next_scan_ = time + scan_seconds();
}

void Gaze::force(const Forced& forced) {
  const auto later = [](const Forced& a, const Forced& b) { return a.time < b.time; };
  forced_.insert(std::upper_bound(forced_.begin(), forced_.end(), forced, later), forced);
}

void Gaze::expect_utterance(double start, double end, double now, bool begins) {
  if (averted_) return;
  const double seconds = away_seconds(Mode::speaking), length = end - start;
  const bool plans = draw_.chance(std::min(1.0, kPlans * liveliness_));
  const double begin = std::max(now, start + draw_.between(-0.2, 0.2));
  const double back = end - std::min(draw_.between(0.3, 0.8), 0.5 * length);
  const double contact = end + draw_.between(0.6, 1.5);
  if (begins && plans && length > 0.8)
    force({begin, true, std::min(begin + seconds, start + 0.6 * length)});
  if (back > now) force({back, false, contact});
}

void Gaze::expect_pause(double start, double end, double now) {
  if (averted_ || !draw_.chance(std::min(1.0, kHesitates * liveliness_))) return;
  const double begin = start + draw_.between(-0.15, 0.1);
  if (begin > now) force({begin, true, end + draw_.between(0.1, 0.5)});
}

void Gaze::hush(double now) {
  forced_.clear();
  if (away_ && !averted_) mode_end_ = std::min(mode_end_, now + draw_.between(0.15, 0.4));
  held_until_ = now + 1;
}

void Gaze::look(const Look& target, double now) {
  set_base(target);
  forced_.clear();
  away_ = averted_;
  saccade(now, averted_ ? away_offset(mode_) : Offset{},
          averted_ ? kElsewhereNear : base_.nearness);
  held_until_ = now + 1;
  mode_end_ = now + (averted_ ? away_seconds(mode_) : std::max(1.0, at_seconds(mode_)));
  next_scan_ = now + scan_seconds();
}

double Gaze::next_event() const {
  const double forced = forced_.empty() ? kNever : forced_.front().time;
  const double ready = start_ + duration_ + kFixation;
  return std::max(std::min({forced, mode_end_, next_scan_, next_micro_}), ready);
}

void Gaze::handle(double time, Mode mode) {
  if (!forced_.empty() && forced_.front().time <= time) {
    const Forced forced = forced_.front();
    forced_.pop_front();
    if (forced.away) {
      if (forced.until > time + kLeastAway) go_away(time, forced.until - time, mode);
      return;
    }
    if (away_) come_back(time, mode);
    held_until_ = forced.until;
    return;
  }
  if (mode_end_ <= time) {
    if (averted_) {
      go_away(time, away_seconds(mode), mode);
    } else if (away_) {
      come_back(time, mode);
    } else if (time < held_until_) {
      mode_end_ = held_until_ + draw_.between(0, 0.6);
    } else if (time > end_ - 1.2) {
      mode_end_ = kNever;  // a clip ends with eye contact
    } else {
      go_away(time, std::min(away_seconds(mode), end_ - 0.5 - time), mode);
    }
    return;
  }
  if (next_scan_ <= time) return scan(time);
  // A micro-saccade: back towards the middle, a little beyond.
  micro_ = {draw_.between(-kMicro, kMicro), draw_.between(-kMicro, kMicro)};
  next_micro_ = time + std::max(0.15, draw_.exponential(kMicroEvery, 4));
}

std::optional<GazeShift> Gaze::advance(double now, double until, Mode mode) {
  if (mode != mode_) {
    mode_ = mode;
    // What the other mode had planned no longer counts.
    if (mode == Mode::thinking) held_until_ = now;
    if (!averted_ && now >= held_until_) {
      const double share = away_ ? 1 : draw_.between(0.2, 1);
      mode_end_ = now + (away_ ? away_seconds(mode) : at_seconds(mode) * share);
      if (mode == Mode::thinking && !away_) mode_end_ = now + draw_.between(0.05, 0.3);
    }
  }
  std::optional<GazeShift> largest;
  for (double next = next_event(); next < until; next = next_event()) {
    const double time = std::max(next, now), before = start_;
    handle(time, mode);
    if (start_ != before && (!largest || size_ > largest->size)) largest = {time, size_};
  }
  return largest;
}

EyeAngles eyes_in_head(const Aim& aim, double head_pitch, double head_yaw, double head_roll) {
  const double yaw = aim.yaw * kRadians, pitch = aim.pitch * kRadians;
  // As the head sees it: undo yaw, then pitch, then roll (fap/semantics.md, section 1).
  const double x = std::sin(yaw) * std::cos(pitch), y = -std::sin(pitch);
  const double z = std::cos(yaw) * std::cos(pitch);
  const double cy = std::cos(head_yaw), sy = std::sin(head_yaw);
  const double x1 = cy * x - sy * z, z1 = sy * x + cy * z;
  const double cp = std::cos(head_pitch), sp = std::sin(head_pitch);
  const double y2 = cp * y + sp * z1, z2 = cp * z1 - sp * y;
  const double cr = std::cos(head_roll), sr = std::sin(head_roll);
  const double x3 = cr * x1 + sr * y2, y3 = cr * y2 - sr * x1;
  EyeAngles eyes;
  for (std::size_t side = 0; side < 2; ++side) {
    const double from = (side == 0 ? kHalfEyes : -kHalfEyes) * aim.nearness;
    const double turn = std::atan2(x3 - from, z2);
    eyes.yaw[side] = std::clamp(turn, -kEyeYaw * kRadians, kEyeYaw * kRadians);
  }
  // Both at the same height, as far as the place between them: less than a tenth of a degree off,
  // and decoders mirror what is equal.
  const double down = std::atan2(-y3, std::hypot(x3, z2));
  eyes.pitch.fill(std::clamp(down, -kEyeUp * kRadians, kEyeDown * kRadians));
  return eyes;
}

}  // namespace animeme::dam::behaviour
