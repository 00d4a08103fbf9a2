#include "dam/speaking/tongue.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "dam/maths/raised_cosine.h"
#include "dam/script/features.h"
#include "dam/signal/arkit_signal.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

constexpr double kTongueComes = 0.09, kTongueGoes = 0.08;  // seconds
constexpr double kTeethGap = 60;    // FAP units beyond kClosedGap: the tongue may pass the teeth
constexpr double kCurled = 30000;   // 1e-5 rad, of R and ER
constexpr double kRollStep = 8192;  // likewise
constexpr double kContactWeight = 3, kHissWeight = 2.5, kGlideWeight = 1.5;  // of a vowel

struct Target {
  TonguePose pose;
  double weight = 0;  // 0: none of its own
};

Target vowel_target(const Features& sound) {
  const double front = 1 - sound.backness;
  TonguePose pose;
  pose.tip_up = -90 + sound.height * (230 * front + 50);
  pose.back_up = -60 + sound.height * (230 * front + 130 * sound.backness);
  if (sound.rhotic) {
    pose.tip_up += 250;
    pose.back_up += 120;
    pose.rolled = kCurled;
    return {pose, kGlideWeight};
  }
  return {pose, 1};
}

Target glide_target(const Features& sound) {
  if (sound.rhotic) return {{350, 0, 150, kCurled}, kHissWeight};
  switch (sound.place) {
    case Place::palatal:
      return {{80, 0, 380, 0}, kGlideWeight};
    case Place::velar:
    case Place::bilabial:  // W: round lips, the back up
      return {{-60, 0, 200, 0}, kGlideWeight};
    default:
      return {};
  }
}

// Where the tongue makes a contact, or nearly does.
Target consonant_target(const Features& sound) {
  const bool hiss = sound.manner == Manner::fricative;
  const double weight = hiss ? kHissWeight : kContactWeight;
  switch (sound.place) {
    case Place::dental:
      return hiss ? Target{{330, 190, 0, 0}, kContactWeight} : Target{{560, 40, 60, 0}, weight};
    case Place::alveolar:
      return hiss ? Target{{300, 0, 100, 0}, weight} : Target{{670, 0, 110, 0}, weight};
    case Place::retroflex:
      return {{560, 0, 150, 0.5 * kCurled}, weight};
    case Place::postalveolar:
    case Place::alveolopalatal:
      return hiss ? Target{{340, 0, 200, 0}, weight} : Target{{560, 0, 180, 0}, weight};
    case Place::palatal:
      return {{60, 0, 450, 0}, weight};
    case Place::velar:
    case Place::uvular:
      return {{-100, 0, 520, 0}, weight};
    case Place::pharyngeal:
      return {{-120, 0, 60, 0}, 1};
    default:
      return {};
  }
}

Target target_of(const Features& sound) {
  if (sound.manner == Manner::vowel) return vowel_target(sound);
  if (sound.closure > 0) return {};  // labials: the tongue goes from neighbour to neighbour
  if (sound.manner == Manner::approximant) return glide_target(sound);
  return consonant_target(sound);
}

double stepped(double value, double step) { return step * std::round(value / step); }

}  // namespace

TongueCurves::TongueCurves(const Script& script) {
  for (const Phone& phone : script.phones) {
    const auto features = phone_features(phone.label);
    const double share = phone.duration() / double(std::max<std::size_t>(features.size(), 1));
    for (std::size_t i = 0; i < features.size(); ++i) {
      const Target target = target_of(features[i]);
      if (!(target.weight > 0)) continue;
      const double start = phone.start + double(i) * share;
      sounds_.push_back({start, start + share, target.weight, target.pose});
      longest_ = std::max(longest_, share);
    }
  }
}

TonguePose TongueCurves::at(double seconds) const {
  auto sound = std::lower_bound(sounds_.begin(), sounds_.end(), seconds - longest_ - kTongueGoes,
                                [](const Sound& one, double time) { return one.start < time; });
  TonguePose sum;
  double weights = 0;
  for (; sound != sounds_.end() && sound->start <= seconds + kTongueComes; ++sound) {
    const double near = raised_step((seconds - sound->start) / kTongueComes + 1) *
                        raised_step((sound->end - seconds) / kTongueGoes + 1);
    const double weight = near * sound->weight;
    sum.tip_up += weight * sound->pose.tip_up;
    sum.tip_out += weight * sound->pose.tip_out;
    sum.back_up += weight * sound->pose.back_up;
    sum.rolled += weight * sound->pose.rolled;
    weights += weight;
  }
  // At the edges of speech it comes from rest.
  const double scale = 1 / std::max(weights, 1.0);
  sum.tip_up *= scale;
  sum.tip_out *= scale;
  sum.back_up *= scale;
  sum.rolled *= scale;
  return sum;
}

bool has_tongue(const Signal& signal) {
  const bool faps = std::any_of(signal.names.begin(), signal.names.end(), [](const auto& name) {
    const int fap = fap_of_channel(name);
    return fap >= 43 && fap <= 47;
  });
  if (faps) return true;
  const auto layout = find_arkit_layout(signal.names);
  return layout && layout->has[std::size_t(fap::find_arkit("tongueOut").value_or(0))];
}

bool add_tongue(Signal& signal, const Script& script) {
  const bool mouth = std::any_of(signal.names.begin(), signal.names.end(), [](const auto& name) {
    const int fap = fap_of_channel(name);
    return fap >= 3 && fap <= 13;
  });
  if (!mouth || has_tongue(signal)) return false;
  const auto lips = inner_lip_channels(signal.names);
  const TongueCurves curves(script);
  const std::size_t frames = signal.frames(), before = signal.names.size();
  std::vector<double> values;
  values.reserve(frames * (before + 4));
  for (std::size_t i = 0; i < frames; ++i) {
    TonguePose pose = curves.at(signal.time(i));
    if (lips && pose.tip_out > 0)
      pose.tip_out *= raised_step((inner_gap(signal, i, *lips) - kClosedGap) / kTeethGap);
    const auto row = signal.values.begin() + std::ptrdiff_t(i * before);
    values.insert(values.end(), row, row + std::ptrdiff_t(before));
    values.push_back(stepped(pose.tip_up, kTongueStep));
    values.push_back(stepped(pose.tip_out, kTongueStep));
    values.push_back(stepped(pose.back_up, kTongueStep));
    values.push_back(stepped(pose.rolled, kRollStep));
  }
  for (const int fap : {44, 45, 46, 47}) signal.names.push_back(fap_channel(fap));
  signal.values = std::move(values);
  return true;
}

}  // namespace animeme::dam
