#include "tools/formats/inspect/warped_speakers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "dam/evaluation/evaluate.h"
#include "dam/script/features.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"

namespace animeme::inspect {
namespace {

using dam::Phone;
using dam::Signal;
using dam::Utterance;

constexpr double kFallOff = 0.05;      // seconds over which the habits of a phone fade
constexpr double kKnots = 0.08;        // seconds between the knots of motion without a phone
constexpr double kRestFrom = 0.1;      // seconds from the speech at which the mouth begins to rest
constexpr double kRestAt = 0.25;       // and at which it does
constexpr double kLeastOpening = 0.2;  // bending: smaller gaps, in deviations, count as this
constexpr double kFreeFrom = 0.6;      // gap, in deviations, from which habits act in full
constexpr double kLeastLeft = 0.2;     // of a gap that habits narrow
constexpr double kUpperShare = 0.35;   // of the upper lip in a change of the gap
constexpr double kSides = 0.8, kUpperOuter = 0.6, kLowerOuter = 0.9;

// ---- numbers that look random ----

/// Of a name, anywhere the same.
std::uint64_t hash_of(std::string_view text, std::uint64_t hash = 0xcbf29ce484222325u) {
  for (const char c : text) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3u;
  return (hash ^ 0xffu) * 0x100000001b3u;
}

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(seed) {}
  double uniform() {  // 0..1
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return double((z ^ (z >> 31)) >> 11) / double(std::uint64_t(1) << 53);
  }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// Nearly normal, with deviation 1: without the logarithms that libraries round in their own way.
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

double normal_of(std::string_view speaker, std::string_view what, std::size_t number) {
  return Draws(hash_of(what, hash_of(speaker)) + number).normal();
}

double step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// ---- channels ----

enum class Part : std::uint8_t { none, upper, lower, other };

/// What a channel is to the habits.
struct Channel {
  std::optional<Articulator> articulator;
  Part part = Part::none;  // of the lips
  double follow = 1;       // share of what moves the middle of the inner lips
  double side = 0;         // 1 left, -1 right
  bool shifted = false;    // habits move it; all others are only scaled
};

Channel channel_of(std::string_view name) {
  using enum Articulator;
  const int fap = dam::fap_of_channel(name);
  const auto lip = [](Part part, double follow, double side) {
    return Channel{Articulator::lips, part, follow, side, true};
  };
  switch (fap) {
    case 3:
      return {jaw, Part::other, 1, 0, true};
    case 4:
      return lip(Part::upper, 1, 0);
    case 5:
      return lip(Part::lower, 1, 0);
    case 8:
    case 9:
      return lip(Part::upper, kSides, fap == 8 ? 1 : -1);
    case 10:
    case 11:
      return lip(Part::lower, kSides, fap == 10 ? 1 : -1);
    case 51:
      return lip(Part::upper, kUpperOuter, 0);
    case 52:
      return lip(Part::lower, kLowerOuter, 0);
    case 55:
    case 56:
      return lip(Part::upper, kSides * kUpperOuter, fap == 55 ? 1 : -1);
    case 57:
    case 58:
      return lip(Part::lower, kSides * kLowerOuter, fap == 57 ? 1 : -1);
    case 6:
    case 7:
    case 53:
    case 54:
      return {width, Part::other, 1, fap == 6 || fap == 53 ? 1.0 : -1.0, true};
    case 12:
    case 13:
    case 59:
    case 60:
      return {corners, Part::other, 1, fap == 12 || fap == 59 ? 1.0 : -1.0, true};
    case 14:
    case 15:
      return {forward, Part::other, 1, 0, false};
    case 16:
    case 17:
      return {forward, Part::other, 1, 0, true};
    default:
      return {};
  }
}

// ---- durations ----

/// The script with other durations, and where its times were before.
struct Paced {
  dam::Script script;
  std::vector<double> now = {0}, before = {0};  // seconds, ascending

  double source_of(double time) const {
    const auto at = std::upper_bound(now.begin(), now.end(), time);
    if (at == now.begin()) return before.front() + time - now.front();
    if (at == now.end()) return before.back() + time - now.back();
    const auto i = std::size_t(at - now.begin());
    const double share = (time - now[i - 1]) / std::max(1e-9, now[i] - now[i - 1]);
    return before[i - 1] + share * (before[i] - before[i - 1]);
  }
};

bool is_vowel(const std::string& label) {
  const auto features = dam::phone_features(label);
  return !features.empty() && features[0].manner == dam::Manner::vowel;
}

Paced paced(const dam::Script& script, const SpeakerHabits& habits) {
  Paced out;
  for (const Phone& phone : script.phones) {
    double factor = 1;
    if (phone.label != dam::kSilence) {
      factor = habits.pace * (is_vowel(phone.label) ? habits.vowels : 1) *
               std::exp2(habits.uneven / std::numbers::ln2 *
                         normal_of(habits.name, "pace" + phone.label, 0));
    }
    if (phone.start > out.before.back()) {  // a gap
      out.now.push_back(out.now.back() + phone.start - out.before.back());
      out.before.push_back(phone.start);
    }
    Phone moved = phone;
    moved.start = out.now.back();
    moved.end = moved.start + std::clamp(factor, 0.5, 2.0) * phone.duration();
    out.now.push_back(moved.end);
    out.before.push_back(phone.end);
    out.script.phones.push_back(std::move(moved));
  }
  return out;
}

// ---- motion ----

/// What all sentences of the recorded speaker have in common.
struct Recorded {
  std::vector<Channel> channels;
  std::vector<double> deviation;
  std::size_t upper = 0, lower = 0;  // FAP 4 and 5
  bool has_lips = false;
  double gap_deviation = 1;

  double gap(const double* row) const { return has_lips ? -(row[upper] + row[lower]) : 0; }
};

Recorded recorded_of(std::span<const Utterance> sentences) {
  Recorded out;
  std::vector<const Utterance*> all;
  for (const Utterance& u : sentences) all.push_back(&u);
  int found = 0;
  for (const dam::Control& control : dam::recording_scale(all)) {
    const int fap = dam::fap_of_channel(control.name);
    if (fap == 4) out.upper = out.channels.size();
    if (fap == 5) out.lower = out.channels.size();
    found += fap == 4 || fap == 5 ? 1 : 0;
    out.channels.push_back(channel_of(control.name));
    out.deviation.push_back(control.sd);
  }
  out.has_lips = found == 2;
  double count = 0, sum = 0, squares = 0;
  for (const Utterance* u : all) {
    if (!out.has_lips || u->script.phones.empty()) continue;
    for (std::size_t i = 0; i < u->signal.frames(); ++i) {
      const double time = u->signal.time(i);
      const bool spoken =
          std::any_of(u->script.phones.begin(), u->script.phones.end(), [&](const Phone& phone) {
            return phone.label != dam::kSilence && phone.start <= time && time < phone.end;
          });
      if (!spoken) continue;
      const double gap = out.gap(&u->signal.values[i * u->signal.names.size()]);
      count += 1;
      sum += gap;
      squares += gap * gap;
    }
  }
  if (count > 1) out.gap_deviation = std::sqrt(squares / count - sum * sum / (count * count));
  return out;
}

using Motion = std::array<double, kArticulators>;  // deviations

/// Where a speaker wants the articulators in a phone, beside where the recorded one has them.
Motion target_of(const SpeakerHabits& habits, const Phone& phone, std::string_view next) {
  Motion target{};
  if (phone.label == dam::kSilence) return target;
  for (std::size_t a = 0; a < kArticulators; ++a) {
    target[a] = habits.habits * normal_of(habits.name, phone.label, a) +
                habits.contexts * normal_of(habits.name, phone.label + " " + std::string(next), a);
  }
  double& lips = target[std::size_t(Articulator::lips)];
  lips = 0.8 * lips + 0.6 * target[std::size_t(Articulator::jaw)];
  if (habits.wide_iy) {
    if (phone.label == "IY") lips = 1.5;
    if (phone.label == "S" || phone.label == "Z") lips = 1;
    if (phone.label == "AA") lips = -1.5;
  }
  return target;
}

/// Motion beside the recorded one, in deviations, over time.
class Extra {
 public:
  Extra(const SpeakerHabits& habits, const std::string& id, const dam::Script& script)
      : script_(script) {
    for (std::size_t p = 0; p < script.phones.size(); ++p) {
      targets_.push_back(target_of(
          habits, script.phones[p],
          p + 1 < script.phones.size() ? script.phones[p + 1].label : std::string(dam::kSilence)));
    }
    Draws draws(hash_of(id, hash_of(habits.name)));
    for (double& level : posture_) level = habits.posture * draws.normal();
    knots_.resize(std::size_t(script.duration() / kKnots) + 3);
    for (Motion& knot : knots_)
      for (double& value : knot) value = habits.noise * draws.normal();
  }

  Motion operator()(double time) const {
    Motion out = posture_;
    const double at = std::clamp(time / kKnots, 0.0, double(knots_.size() - 2));
    const auto knot = std::size_t(at);
    const double share = step(at - double(knot));
    double weights = 1e-9;
    Motion sum{};
    for (std::size_t p = 0; p < targets_.size(); ++p) {
      const Phone& phone = script_.phones[p];
      const double far = std::max({0.0, phone.start - time, time - phone.end}) / kFallOff;
      if (far > 4) continue;
      const double weight = std::exp(-far * far);
      weights += weight;
      for (std::size_t a = 0; a < kArticulators; ++a) sum[a] += weight * targets_[p][a];
    }
    for (std::size_t a = 0; a < kArticulators; ++a)
      out[a] += sum[a] / weights + (1 - share) * knots_[knot][a] + share * knots_[knot + 1][a];
    return out;
  }

  /// How much of the resting mouth shows: 0 in speech, 1 in silence.
  double rest(double time) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Phone& phone : script_.phones)
      if (phone.label != dam::kSilence)
        nearest = std::min(nearest, std::max({0.0, phone.start - time, time - phone.end}));
    return step((nearest - kRestFrom) / (kRestAt - kRestFrom));
  }

 private:
  const dam::Script& script_;
  std::vector<Motion> targets_, knots_;
  Motion posture_{};
};

/// A value between frames.
double sample(const Signal& signal, std::size_t channel, double time) {
  const double at = std::clamp(time * signal.rate.frames_per_second(), 0.0,
                               double(std::max<std::size_t>(signal.frames(), 1) - 1));
  const auto i = std::size_t(at);
  const double share = at - double(i);
  const double here = signal.at(i, channel);
  return share > 0 ? here + share * (signal.at(i + 1, channel) - here) : here;
}

double bent(double value, double deviation, double bend) {
  if (bend == 1 || !(deviation > 0)) return value;
  return std::copysign(deviation * std::pow(std::abs(value) / deviation, bend), value);
}

/// A row of the copy. `row`: what the recorded speaker does then.
void warp_row(const Recorded& recorded, const SpeakerHabits& habits, const Motion& extra,
              double rest, double* row) {
  const double deviation = recorded.gap_deviation;
  const double gap = std::max(0.0, recorded.gap(row)) / deviation;
  const double lip_range = habits.range[std::size_t(Articulator::lips)];
  const double lip_factor = lip_range * std::pow(std::max(gap, kLeastOpening), habits.bend - 1);
  // Lips that meet stay together, whatever habits say.
  const double shown =
      std::max(-(1 - kLeastLeft) * gap * lip_factor,
               lip_range * step(gap / kFreeFrom) * extra[std::size_t(Articulator::lips)]);
  const double wider = shown * deviation + rest * habits.gap_rest;
  for (std::size_t c = 0; c < recorded.channels.size(); ++c) {
    const Channel& channel = recorded.channels[c];
    if (!channel.articulator) continue;
    const auto a = std::size_t(*channel.articulator);
    double& value = row[c];
    if (channel.part == Part::upper || channel.part == Part::lower) {
      const double share = channel.part == Part::upper ? kUpperShare : 1 - kUpperShare;
      value = value * lip_factor - channel.follow * share * wider;
    } else {
      value = habits.range[a] * bent(value, recorded.deviation[c], habits.bend);
      if (channel.shifted) value += habits.range[a] * extra[a] * recorded.deviation[c];
      if (*channel.articulator == Articulator::jaw)
        value += habits.jaw_level + rest * habits.jaw_rest;
    }
    value *= 1 + channel.side * habits.asymmetry;
  }
}

Utterance warped(const Utterance& u, const Recorded& recorded, const SpeakerHabits& habits) {
  const Paced pace = paced(u.script, habits);
  Utterance out{u.id, u.text, pace.script, {}, u.fields};
  const Signal& from = u.signal;
  Signal& to = out.signal;
  to.rate = from.rate;
  to.names = from.names;
  const std::size_t k = from.names.size();
  const double longer = pace.now.back() - pace.before.back();
  const auto frames = std::size_t(std::max(
      1.0, std::floor(double(from.frames()) + longer * from.rate.frames_per_second() + 0.5)));
  to.values.resize(frames * k);
  if (!from.measured.empty()) to.measured.resize(frames);
  const Extra extra(habits, u.id, pace.script);
  for (std::size_t i = 0; i < frames; ++i) {
    const double time = to.time(i), source = pace.source_of(time);
    const double late = pace.source_of(time - habits.lips_late);
    for (std::size_t c = 0; c < k; ++c) {
      const auto& articulator = recorded.channels[c].articulator;
      const bool lips = articulator && *articulator != Articulator::jaw;
      to.at(i, c) = sample(from, c, lips ? late : source);
    }
    if (!from.measured.empty()) {
      const auto near = std::size_t(
          std::clamp(source * from.rate.frames_per_second() + 0.5, 0.0, double(from.frames() - 1)));
      to.measured[i] = from.measured[near];
    }
    warp_row(recorded, habits, extra(time - habits.lips_late), extra.rest(time), &to.values[i * k]);
  }
  return out;
}

}  // namespace

std::vector<SpeakerHabits> warped_habits(std::size_t count) {
  std::vector<SpeakerHabits> all;
  for (std::size_t s = 0; s < count; ++s) {
    SpeakerHabits h;
    h.name = "w" + std::to_string(s + 1);
    Draws draws(hash_of(h.name));
    for (double& range : h.range) range = std::exp2(draws.between(-1, 0.8));
    h.bend = draws.between(0.8, 1.25);
    h.habits = draws.between(0.9, 1.3);
    h.contexts = draws.between(0.3, 0.6);
    h.asymmetry = draws.between(-0.25, 0.25);
    h.lips_late = draws.between(-0.03, 0.03);
    h.pace = draws.between(0.85, 1.25);
    h.vowels = draws.between(0.8, 1.3);
    h.uneven = draws.between(0.05, 0.2);
    h.noise = draws.between(0.5, 0.9);
    h.posture = draws.between(0.1, 0.5);
    h.jaw_rest = draws.between(-40, 160);
    h.gap_rest = std::max(0.0, draws.between(-300, 400));
    h.jaw_level = draws.between(-50, 100);
    if (s == 0) h.jaw_rest = 200;
    if (s == 1) h.gap_rest = 450;
    if (s == 2) h.wide_iy = true;
    if (s == 3) {
      h.jaw_rest = 200;
      h.gap_rest = 450;
      h.wide_iy = true;
    }
    all.push_back(std::move(h));
  }
  return all;
}

Result<std::vector<Utterance>> warp(std::span<const Utterance> sentences,
                                    const SpeakerHabits& habits) {
  const auto bad = [](const std::string& what) { return make_error(Code::invalid_argument, what); };
  if (sentences.empty()) return bad("there is no sentence to warp");
  for (const Utterance& u : sentences)
    if (u.signal.names != sentences[0].signal.names || u.signal.frames() == 0)
      return bad("sentence '" + u.id + "' has other controls than the first, or no frames");
  const Recorded recorded = recorded_of(sentences);
  if (std::none_of(recorded.channels.begin(), recorded.channels.end(),
                   [](const Channel& c) { return c.articulator.has_value(); }))
    return bad("warping needs FAPs of the jaw and the lips (3 to 17, 51 to 60)");
  std::vector<Utterance> out;
  for (const Utterance& u : sentences) out.push_back(warped(u, recorded, habits));
  return out;
}

}  // namespace animeme::inspect
