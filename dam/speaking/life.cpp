#include "dam/speaking/life.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dam/maths/raised_cosine.h"
#include "dam/maths/random.h"
#include "dam/script/phones.h"
#include "dam/script/timeline_internal.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

constexpr double kPause = 0.25, kLeastInterval = 1, kShortInterval = 2, kLongInterval = 6;
constexpr double kClosing = 0.08, kClosed = 0.04, kOpening = 0.16;
constexpr double kDrawnOut = 1.4, kAccentDistance = 0.6, kBefore = 0.15, kAfter = 0.35;
constexpr double kUpperLid = 940, kLowerLid = 84;         // IRISD units, 1024 together: closed
constexpr double kBrow = 60;                              // ENS units, about 3 mm
constexpr double kDegree = std::numbers::pi / 180 * 1e5;  // in units of 1e-5 rad
constexpr double kNod = 1.5;                              // degrees

/// Up from `begin` to `top`, down from `fall` to `end`.
double bump(double time, double begin, double top, double fall, double end) {
  return std::min(raised_step((time - begin) / (top - begin)),
                  raised_step((end - time) / (end - fall)));
}

std::vector<double> blink_times(const std::vector<Stretch>& speech, double duration,
                                Random& random) {
  std::vector<double> wished;
  for (std::size_t i = 0; i < speech.size(); ++i) {
    const double next = i + 1 < speech.size() ? speech[i + 1].start : duration;
    if (next - speech[i].end >= kPause) wished.push_back(speech[i].end + 0.05);
  }
  std::vector<double> times;
  double last = 0;
  std::size_t w = 0;
  for (;;) {
    double next = last + random.between(kShortInterval, kLongInterval);
    while (w < wished.size() && wished[w] < last + kLeastInterval) ++w;
    if (w < wished.size() && wished[w] < next + kLeastInterval) next = wished[w];
    if (next + kClosing + kClosed + kOpening > duration) return times;
    times.push_back(next);
    last = next;
  }
}

struct Accent {
  double start = 0, end = 0;
  double weight = 0;
};

bool is_vowel(const Phone& phone) {
  const PhoneInfo* info = find_phone(phone.label);
  return info != nullptr && info->vowel;
}

double median_vowel(const Script& script) {
  std::vector<double> seconds;
  for (const Phone& phone : script.phones)
    if (is_vowel(phone)) seconds.push_back(phone.duration());
  if (seconds.empty()) return 0;
  const auto middle = seconds.begin() + std::ptrdiff_t(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

std::vector<Accent> find_accents(const Script& script, const std::vector<Stretch>& speech) {
  const double usual = median_vowel(script);
  std::vector<Accent> accents;
  for (const Stretch& stretch : speech) {
    std::vector<Phone> vowels;
    for (const Phone& phone : script.phones)
      if (is_vowel(phone) && phone.start >= stretch.start && phone.end <= stretch.end)
        vowels.push_back(phone);
    std::stable_sort(vowels.begin(), vowels.end(),
                     [](const Phone& a, const Phone& b) { return a.duration() > b.duration(); });
    std::vector<Accent> here;
    for (const Phone& vowel : vowels) {
      if (!here.empty() && vowel.duration() < kDrawnOut * usual) break;
      const bool near = std::any_of(here.begin(), here.end(), [&](const Accent& a) {
        return std::abs(a.start - vowel.start) < kAccentDistance;
      });
      if (!near) here.push_back({vowel.start, vowel.end, here.empty() ? 1.0 : 0.5});
    }
    accents.insert(accents.end(), here.begin(), here.end());
  }
  return accents;
}

/// What rules say for one moment.
struct Moment {
  double lids = 0, accent = 0, pitch = 0, yaw = 0, roll = 0;
};

class Rules {
 public:
  Rules(const Script& script, double duration, const LifeOptions& options) : duration_(duration) {
    Random random(options.seed);
    const auto speech = speech_stretches(script);
    for (double& phase : phase_) phase = random.between(0, 2 * std::numbers::pi);
    blinks_ = blink_times(speech, duration, random);
    accents_ = find_accents(script, speech);
  }

  Moment at(double time) const {
    Moment m;
    for (const double b : blinks_)
      m.lids = std::max(m.lids, bump(time, b, b + kClosing, b + kClosing + kClosed,
                                     b + kClosing + kClosed + kOpening));
    for (const Accent& a : accents_) {
      const double middle = (a.start + a.end) / 2;
      m.accent = std::max(m.accent,
                          a.weight * bump(time, a.start - kBefore, middle, middle, a.end + kAfter));
    }
    const double shown = bump(time, 0, 1, duration_ - 1, duration_);
    const auto sine = [&](std::size_t i, double period) {
      return std::sin(2 * std::numbers::pi * time / period + phase_[i]);
    };
    m.pitch = shown * 0.3 * (sine(0, 7.3) + sine(1, 3.1));
    m.yaw = shown * 0.45 * (sine(2, 9.7) + sine(3, 4.3));
    m.roll = shown * 0.25 * (sine(4, 11.1) + sine(5, 5.3));
    return m;
  }
  LifeReport report() const { return {blinks_.size(), accents_.size()}; }

 private:
  double duration_;
  double phase_[6] = {};
  std::vector<double> blinks_;
  std::vector<Accent> accents_;
};

double value_of(int fap, const Moment& m, double amount) {
  switch (fap) {
    case 19:
    case 20:
      return kUpperLid * m.lids;
    case 21:
    case 22:
      return kLowerLid * m.lids;
    case 48:
      return amount * kDegree * (m.pitch + kNod * m.accent);
    case 49:
      return amount * kDegree * m.yaw;
    case 50:
      return amount * kDegree * m.roll;
    default:  // brows, the outer ends less
      return amount * kBrow * m.accent * (fap >= 35 ? 0.6 : 1.0);
  }
}

constexpr int kLifeFaps[] = {19, 20, 21, 22, 31, 32, 33, 34, 35, 36, 48, 49, 50};

}  // namespace

Result<LifeReport> add_life(Signal& signal, const Script& script, const LifeOptions& options) {
  if (!(options.amount >= 0 && options.amount <= 2))
    return make_error(Code::invalid_argument, "the amount of life must lie between 0 and 2");
  if (signal.first_frame != 0)
    return make_error(Code::invalid_argument, "life can be added to whole clips only");
  std::vector<int> known;
  for (const std::string& name : signal.names) known.push_back(fap_of_channel(name));
  if (std::all_of(known.begin(), known.end(), [](int fap) { return fap == 0; }))
    return make_error(Code::unsupported,
                      "the controls are no FAPs, so blinks and nods have nothing to move");
  std::vector<int> added;
  for (const int fap : kLifeFaps)
    if (std::find(known.begin(), known.end(), fap) == known.end()) added.push_back(fap);
  const std::size_t frames = signal.frames(), controls = signal.names.size();
  const Rules rules(script, signal.rate.seconds(double(frames)), options);
  std::vector<double> values;
  values.reserve(frames * (controls + added.size()));
  for (std::size_t i = 0; i < frames; ++i) {
    const auto row = signal.values.begin() + std::ptrdiff_t(i * controls);
    values.insert(values.end(), row, row + std::ptrdiff_t(controls));
    const Moment moment = rules.at(signal.time(i));
    for (const int fap : added) values.push_back(value_of(fap, moment, options.amount));
  }
  for (const int fap : added) signal.names.push_back(fap_channel(fap));
  signal.values = std::move(values);
  return rules.report();
}

}  // namespace animeme::dam
