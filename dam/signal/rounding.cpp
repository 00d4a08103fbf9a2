#include "dam/signal/rounding.h"

#include <algorithm>
#include <utility>

#include "dam/maths/raised_cosine.h"
#include "dam/script/features.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

constexpr double kOfSibilants = 0.7;  // SH, CH: forward, but open; of other consonants as they are
constexpr double kLeastOfVowels = 0.55;  // an open rounded vowel, of a close one

// How much a sound has to say about the rounding of the lips.
double weight_of(const Features& sound) {
  if (sound.manner == Manner::vowel) return 1;
  if (sound.closure == 0.5) return 0.7;  // F, V: the lip is at the teeth
  if (sound.rounding > 0) return 1;
  const bool glide = sound.manner == Manner::approximant && sound.place == Place::palatal;
  return glide ? 0.7 : 0;
}

double wish_of(const Features& sound) {
  const double round = std::clamp(sound.rounding, 0.0, 1.0);
  if (sound.manner == Manner::vowel) {
    return round * (kLeastOfVowels + (1 - kLeastOfVowels) * sound.height);
  }
  return sound.manner == Manner::approximant ? round : kOfSibilants * round;
}

}  // namespace

LipRounding::LipRounding(const Script& script, const RoundingOptions& options) : options_(options) {
  for (const Phone& phone : script.phones) {
    const auto sounds = phone_features(phone.label);
    const double share = phone.duration() / double(std::max<std::size_t>(sounds.size(), 1));
    for (std::size_t i = 0; i < sounds.size(); ++i) {
      const double weight = weight_of(sounds[i]);
      if (weight <= 0) continue;
      const double start = phone.start + double(i) * share;
      wishes_.push_back({start, start + share, wish_of(sounds[i]), weight});
      longest_ = std::max(longest_, share);
    }
  }
}

double LipRounding::operator()(double time) const {
  // Those that begin too early to reach here are passed over.
  const auto first =
      std::lower_bound(wishes_.begin(), wishes_.end(), time - longest_ - options_.after,
                       [](const Wish& wish, double seconds) { return wish.start < seconds; });
  double sum = 0, weights = 0;
  for (auto wish = first; wish != wishes_.end() && wish->start <= time + options_.before; ++wish) {
    const double near = raised_step((time - wish->start) / options_.before + 1) *
                        raised_step((wish->end - time) / options_.after + 1);
    sum += near * wish->weight * wish->round;
    weights += near * wish->weight;
  }
  return sum / std::max(weights, 1.0);
}

std::size_t add_rounding(const LipRounding& rounding, double amount,
                         const std::function<double(double)>& shown, Signal& signal,
                         const RoundingOptions& options) {
  std::vector<std::pair<std::size_t, double>> channels;
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    const int fap = fap_of_channel(signal.names[c]);
    if (fap == 16 || fap == 17) channels.emplace_back(c, options.forward);
  }
  if (channels.empty() || amount == 0) return channels.size();
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const double time = signal.time(i);
    const double round = amount * rounding(time) * shown(time);
    for (const auto& [channel, far] : channels) signal.at(i, channel) += round * far;
  }
  return channels.size();
}

}  // namespace animeme::dam
