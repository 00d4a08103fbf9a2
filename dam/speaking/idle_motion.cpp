#include "dam/speaking/idle_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dam/maths/raised_cosine.h"
#include "dam/maths/random.h"
#include "dam/script/phones.h"
#include "dam/script/timeline_internal.h"
#include "dam/signal/arkit_signal.h"
#include "dam/signal/fap_signal.h"
#include "fap/arkit.h"

namespace animeme::dam {
namespace {

constexpr double kPause = 0.25, kLeastInterval = 1, kShortInterval = 2, kLongInterval = 6;
constexpr double kClosing = 0.08, kClosed = 0.04, kOpening = 0.16;
constexpr double kDrawnOut = 1.4, kAccentDistance = 0.6, kBefore = 0.15, kAfter = 0.35;
constexpr double kUpperLid = 940, kLowerLid = 84;         // IRISD units, 1024 together: closed
constexpr double kOuterBrow = 0.6;                        // of the inner end
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
  Rules(const Script& script, double duration, const IdleMotionOptions& options)
      : duration_(duration) {
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
  IdleMotionReport report() const { return {blinks_.size(), accents_.size()}; }

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
      return amount * kBrow * m.accent * (fap >= 35 ? kOuterBrow : 1.0);
  }
}

constexpr int kIdleMotionFaps[] = {19, 20, 21, 22, 31, 32, 33, 34, 35, 36, 48, 49, 50};

/// A row of a signal with room for what is added.
class Wider {
 public:
  Wider(Signal& signal, const std::vector<std::string>& added)
      : signal_(signal), before_(signal.names.size()) {
    const std::size_t frames = signal.frames();
    signal.names.insert(signal.names.end(), added.begin(), added.end());
    std::vector<double> values(frames * signal.names.size(), 0.0);
    for (std::size_t i = 0; i < frames; ++i)
      std::copy_n(&signal.values[i * before_], before_, &values[i * signal.names.size()]);
    signal.values = std::move(values);
  }
  template <class Visit>
  void each(const Visit& visit) {
    for (std::size_t i = 0; i < signal_.frames(); ++i)
      visit(signal_.time(i), &signal_.values[i * signal_.names.size()]);
  }

 private:
  Signal& signal_;
  std::size_t before_;
};

void live_faps(Signal& signal, const std::vector<int>& known, const Rules& rules, double amount) {
  std::vector<int> added;
  for (const int fap : kIdleMotionFaps)
    if (std::find(known.begin(), known.end(), fap) == known.end()) added.push_back(fap);
  std::vector<std::string> names;
  for (const int fap : added) names.push_back(fap_channel(fap));
  const std::size_t first = signal.names.size();
  Wider(signal, names).each([&](double time, double* row) {
    const Moment moment = rules.at(time);
    for (std::size_t a = 0; a < added.size(); ++a)
      row[first + a] = value_of(added[a], moment, amount);
  });
}

/// What a shape at 1 does to a FAP, in its units.
double full(int shape, int fap) {
  fap::ArkitFrame weights{};
  weights[std::size_t(shape)] = 1;
  return fap::arkit_to_fap(weights, fap::kAllArkit).value[std::size_t(fap)];
}

/// A channel of ARKit that lives.
struct LivingShape {
  enum class Part : std::uint8_t { lid, wide, brow, pitch, yaw, roll } part;
  int channel;
  double scale = 1;    ///< of what the moment says
  std::size_t at = 0;  ///< column
  bool own = false;    ///< the signal has it already
};

std::vector<LivingShape> living_shapes() {
  using enum LivingShape::Part;
  const auto number = [](std::string_view name) { return *fap::find_arkit(name); };
  const int inner = number("browInnerUp"), left = number("browOuterUpLeft"),
            right = number("browOuterUpRight");
  // Each raises the other end of the brow a little, too.
  const double inner_31 = full(inner, 31), inner_35 = full(inner, 35);
  const double outer_31 = full(left, 31), outer_35 = full(left, 35);
  const double size = kBrow / (inner_31 * outer_35 - inner_35 * outer_31);
  const double inner_up = size * (outer_35 - kOuterBrow * outer_31);
  const double outer_up = size * (kOuterBrow * inner_31 - inner_35);
  return {{lid, number("eyeBlinkLeft")}, {lid, number("eyeBlinkRight")},
          {wide, number("eyeWideLeft")}, {wide, number("eyeWideRight")},
          {brow, inner, inner_up},       {brow, left, outer_up},
          {brow, right, outer_up},       {pitch, number("headPitch")},
          {yaw, number("headYaw")},      {roll, number("headRoll")}};
}

void live(const LivingShape& shape, const Moment& m, double amount, double& value) {
  const double radians = amount * std::numbers::pi / 180;
  switch (shape.part) {
    case LivingShape::Part::lid:
      value = std::max(value, m.lids);
      return;
    case LivingShape::Part::wide:
      value *= 1 - m.lids;
      return;
    case LivingShape::Part::brow:
      value = std::max(value, std::min(1.0, value + amount * shape.scale * m.accent));
      return;
    // Live Link Face turns to the right where FAPs turn to the left, and tilts likewise.
    case LivingShape::Part::pitch:
      if (!shape.own) value = radians * (m.pitch + kNod * m.accent);
      return;
    case LivingShape::Part::yaw:
      if (!shape.own) value = -radians * m.yaw;
      return;
    case LivingShape::Part::roll:
      if (!shape.own) value = -radians * m.roll;
      return;
  }
}

void live_arkit(Signal& signal, const ArkitLayout& layout, const Rules& rules, double amount) {
  std::vector<LivingShape> shapes = living_shapes();
  // Eyes that never open wide need not give way.
  std::erase_if(shapes, [&](const LivingShape& shape) {
    return shape.part == LivingShape::Part::wide && !layout.has[std::size_t(shape.channel)];
  });
  std::vector<std::string> added;
  for (LivingShape& shape : shapes) {
    const auto column = std::find(layout.channel.begin(), layout.channel.end(), shape.channel);
    shape.own = column != layout.channel.end();
    shape.at = shape.own ? std::size_t(column - layout.channel.begin())
                         : signal.names.size() + added.size();
    if (!shape.own) added.push_back(arkit_spelling(shape.channel, signal.names));
  }
  Wider(signal, added).each([&](double time, double* row) {
    const Moment moment = rules.at(time);
    for (const LivingShape& shape : shapes) live(shape, moment, amount, row[shape.at]);
  });
}

}  // namespace

Result<IdleMotionReport> add_idle_motion(Signal& signal, const Script& script,
                                         const IdleMotionOptions& options) {
  if (!(options.amount >= 0 && options.amount <= 2))
    return make_error(Code::invalid_argument, "the amount of idle motion must be between 0 and 2");
  if (signal.first_frame != 0)
    return make_error(Code::invalid_argument, "idle motion can be added to whole clips only");
  std::vector<int> known;
  for (const std::string& name : signal.names) known.push_back(fap_of_channel(name));
  const bool faps = std::any_of(known.begin(), known.end(), [](int fap) { return fap != 0; });
  const auto arkit = find_arkit_layout(signal.names);
  if (!faps && !arkit)
    return make_error(
        Code::unsupported,
        "the controls are neither FAPs nor ARKit shapes, so blinks and nods cannot be "
        "added; use ARKit names such as eyeBlinkLeft");
  const Rules rules(script, signal.rate.seconds(double(signal.frames())), options);
  if (faps)
    live_faps(signal, known, rules, options.amount);
  else
    live_arkit(signal, *arkit, rules, options.amount);
  return rules.report();
}

}  // namespace animeme::dam
