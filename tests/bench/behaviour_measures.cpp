#include "tests/bench/behaviour_measures.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace animeme::bench {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

struct Direction {
  double yaw = 0, pitch = 0;  // degrees, left and down
};

// In the head; both eyes, so that vergence cancels.
Direction in_head(const dam::FaceMoment& m) {
  return {0.5 * (m.eye_yaw[0] + m.eye_yaw[1]) * kDegrees,
          0.5 * (m.eye_pitch[0] + m.eye_pitch[1]) * kDegrees};
}

Direction in_world(const dam::FaceMoment& m) {
  const Direction eye = in_head(m);
  const double yaw = eye.yaw / kDegrees, pitch = eye.pitch / kDegrees;
  double x = std::sin(yaw) * std::cos(pitch), y = -std::sin(pitch);
  double z = std::cos(yaw) * std::cos(pitch);
  const auto turn = [](double& a, double& b, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), before = a;
    a = c * a - s * b;
    b = s * before + c * b;
  };
  turn(x, y, m.head_roll);
  turn(y, z, m.head_pitch);
  turn(z, x, m.head_yaw);
  return {std::atan2(x, z) * kDegrees, std::atan2(-y, std::hypot(x, z)) * kDegrees};
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ma += a[i];
    mb += b[i];
  }
  ma /= double(a.size());
  mb /= double(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

// Power of the velocity in each of the three bands.
std::array<double, 3> band_power(const std::vector<double>& degrees, double hertz) {
  constexpr double kWindow = 8;  // seconds
  const auto length = std::size_t(kWindow * hertz);
  std::array<double, 3> power{};
  for (std::size_t from = 0; from + length + 1 < degrees.size(); from += length) {
    for (int k = 1; double(k) / kWindow < 7; ++k) {
      std::complex<double> sum = 0;
      const double turn = 2 * std::numbers::pi * k / double(length);
      for (std::size_t i = 0; i < length; ++i) {
        const double taper =
            0.5 - 0.5 * std::cos(2 * std::numbers::pi * double(i) / double(length));
        const double velocity = degrees[from + i + 1] - degrees[from + i];
        sum += taper * velocity * std::polar(1.0, -turn * double(i));
      }
      const double f = double(k) / kWindow;
      power[f < 1.8 ? 0 : f < 3.7 ? 1 : 2] += std::norm(sum);
    }
  }
  return power;
}

}  // namespace

double Sample::mean() const {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / double(values.size());
}

double Sample::deviation() const {
  const double m = mean();
  double sum = 0;
  for (const double v : values) sum += (v - m) * (v - m);
  return values.empty() ? 0 : std::sqrt(sum / double(values.size()));
}

double Sample::median() const {
  if (values.empty()) return 0;
  std::vector<double> sorted = values;
  std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2),
                   sorted.end());
  return sorted[sorted.size() / 2];
}

double Sample::share_to(double limit) const {
  const auto count =
      std::count_if(values.begin(), values.end(), [&](double v) { return v <= limit; });
  return values.empty() ? 0 : double(count) / double(values.size());
}

SaccadesSeen saccades_of(const Shown& shown) {
  constexpr double kSpeed = 30, kLeast = 0.7;
  SaccadesSeen seen;
  std::vector<double> peaks;
  double directed = 0;
  const auto& m = shown.moments;
  for (std::size_t i = 1; i < m.size();) {
    const auto speed = [&](std::size_t k) {
      const Direction a = in_world(m[k - 1]), b = in_world(m[k]);
      return std::hypot(b.yaw - a.yaw, b.pitch - a.pitch) * shown.hertz;
    };
    if (speed(i) < kSpeed) {
      ++i;
      continue;
    }
    const std::size_t first = i - 1;
    double fastest = 0;
    for (; i < m.size() && speed(i) >= kSpeed; ++i) fastest = std::max(fastest, speed(i));
    const Direction a = in_world(m[first]), b = in_world(m[i - 1]);
    const double right = -(b.yaw - a.yaw), up = -(b.pitch - a.pitch);
    const double size = std::hypot(right, up);
    if (size < kLeast) continue;
    seen.size.values.push_back(size);
    seen.seconds.values.push_back(double(i - 1 - first) / shown.hertz);
    if (size > 8 && size < 12) peaks.push_back(fastest);
    if (size > 2.5 && std::hypot(a.yaw, a.pitch) < 2) {
      const double turn = std::atan2(up, right) / (2 * std::numbers::pi) * 8 + 8.5;
      seen.directions[std::size_t(turn) % 8] += 1;
      directed += 1;
    }
  }
  for (double& share : seen.directions) share *= 100 / std::max(directed, 1.0);
  seen.peak_10 = Sample{peaks}.mean();
  const double ms = seen.size.mean(), mt = seen.seconds.mean();
  double st = 0, ss = 0;
  for (std::size_t i = 0; i < seen.size.values.size(); ++i) {
    st += (seen.size.values[i] - ms) * (seen.seconds.values[i] - mt);
    ss += (seen.size.values[i] - ms) * (seen.size.values[i] - ms);
  }
  seen.slope = ss > 0 ? 1000 * st / ss : 0;
  seen.intercept = 1000 * mt - seen.slope * ms;
  return seen;
}

ContactSeen contact_of(const Shown& shown) {
  constexpr double kContact = 3, kLeast = 0.1;
  ContactSeen seen;
  std::size_t at = 0, since = 0;
  bool before = true;
  for (std::size_t i = 0; i < shown.moments.size(); ++i) {
    const Direction d = in_world(shown.moments[i]);
    const bool now = std::hypot(d.yaw, d.pitch) <= kContact;
    at += now ? 1 : 0;
    if (now == before) continue;
    const double seconds = double(i - since) / shown.hertz;
    if (seconds >= kLeast && since > 0) (before ? seen.at : seen.away).values.push_back(seconds);
    before = now;
    since = i;
  }
  seen.share = double(at) / double(shown.moments.size());
  return seen;
}

BlinksSeen blinks_of(const Shown& shown) {
  BlinksSeen seen;
  const auto& m = shown.moments;
  double last = -1, count = 0, half = 0, doubled = 0, border = 0, near_borders = 0;
  const auto near = [&](double time) {
    return std::any_of(shown.phrases.begin(), shown.phrases.end(), [&](const auto& phrase) {
      return time > phrase.end - 0.2 && time < phrase.end + 0.4;
    });
  };
  for (std::size_t i = 0; i < m.size(); i += std::size_t(shown.hertz / 10))
    near_borders += near(shown.time(i)) ? 1 : 0;
  for (std::size_t i = 1; i < m.size();) {
    if (m[i].blink <= 0) {
      ++i;
      continue;
    }
    const std::size_t first = i;
    double top = 0;
    std::size_t shut = i, opens = i;
    for (; i < m.size() && m[i].blink > 0; ++i) {
      if (m[i].blink > top + 1e-9) shut = i;
      top = std::max(top, m[i].blink);
      if (m[i].blink >= top - 1e-9) opens = i;
    }
    const double time = shown.time(first);
    count += 1;
    half += top < 0.9 ? 1 : 0;
    border += near(time) ? 1 : 0;
    if (last >= 0) {
      seen.interval.values.push_back(time - last);
      doubled += time - last < 0.65 ? 1 : 0;
    }
    last = time;
    seen.down.values.push_back(double(shut - first + 1) / shown.hertz);
    seen.up.values.push_back(double(i - opens) / shown.hertz);
  }
  const double minutes = double(m.size()) / shown.hertz / 60;
  seen.a_minute = count / minutes;
  seen.half = half / count;
  seen.doubled = doubled / count;
  seen.at_borders = border / count;
  seen.by_chance = near_borders / (minutes * 600);
  return seen;
}

HeadSeen head_of(const Shown& shown) {
  HeadSeen seen;
  Sample axes[3];
  for (const dam::FaceMoment& m : shown.moments) {
    axes[0].values.push_back(m.head_pitch * kDegrees);
    axes[1].values.push_back(m.head_yaw * kDegrees);
    axes[2].values.push_back(m.head_roll * kDegrees);
  }
  double total = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    seen.deviation[axis] = axes[axis].deviation();
    const auto& v = axes[axis].values;
    for (std::size_t i = 1; i < v.size(); ++i)
      seen.fastest = std::max(seen.fastest, std::abs(v[i] - v[i - 1]) * shown.hertz);
    // At a twentieth: 25 Hz show 7 Hz.
    std::vector<double> thin;
    const auto every = std::size_t(shown.hertz / 25);
    for (std::size_t i = 0; i < v.size(); i += every) thin.push_back(v[i]);
    const auto power = band_power(thin, 25);
    for (std::size_t b = 0; b < 3; ++b) {
      seen.bands[b] += power[b];
      total += power[b];
    }
  }
  for (double& band : seen.bands) band /= std::max(total, 1e-12);
  Sample phrases;
  for (const dam::SpeechPhrase& phrase : shown.phrases) {
    std::vector<double> head, voice;
    for (std::size_t i = std::size_t(phrase.start * shown.hertz);
         i < std::min(std::size_t(phrase.end * shown.hertz), shown.semitones.size()); ++i) {
      if (!std::isfinite(shown.semitones[i])) continue;
      head.push_back(shown.moments[i].head_pitch);
      voice.push_back(double(shown.semitones[i]));
    }
    if (double(head.size()) > shown.hertz)
      phrases.values.push_back(std::abs(correlation(head, voice)));
  }
  seen.with_pitch = phrases.mean();
  return seen;
}

BrowsSeen brows_of(const Shown& shown) {
  constexpr double kRaised = 12;  // ENS units
  BrowsSeen seen;
  double count = 0, near_accent = 0, at_rise = 0;
  std::vector<bool> used(shown.accents.size());
  const auto& m = shown.moments;
  const auto height = [&](std::size_t i) {
    return 0.5 * (m[i].middle_brow[0] + m[i].middle_brow[1]);
  };
  for (std::size_t i = 0; i < m.size();) {
    if (height(i) < kRaised) {
      ++i;
      continue;
    }
    const std::size_t first = i;
    std::size_t apex = i;
    for (; i < m.size() && height(i) >= kRaised; ++i)
      if (height(i) > height(apex)) apex = i;
    count += 1;
    seen.seconds.values.push_back(double(i - first) / shown.hertz);
    for (std::size_t a = 0; a < shown.accents.size(); ++a) {
      const dam::SpeechAccent& accent = shown.accents[a];
      const double middle = 0.5 * (accent.start + accent.end);
      if (used[a] || std::abs(shown.time(apex) - middle) > 0.2) continue;
      used[a] = true;
      near_accent += 1;
      at_rise += accent.rise ? 1 : 0;
      break;
    }
  }
  seen.a_minute = count / (double(m.size()) / shown.hertz / 60);
  seen.at_rise = at_rise / std::max(near_accent, 1.0);
  seen.of_accents = near_accent / std::max(double(shown.accents.size()), 1.0);
  return seen;
}

}  // namespace animeme::bench
