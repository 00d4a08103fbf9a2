#include "dam/signal/mouth_opening.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "dam/maths/raised_cosine.h"
#include "dam/script/features.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

bool has_teeth_together(const Features& sound) {
  return (sound.manner == Manner::fricative || sound.manner == Manner::affricate) &&
         sound.place >= Place::alveolar && sound.place < Place::palatal;
}

std::optional<MouthOpening::Target> wish_of(const Features& sound, const OpeningOptions& options) {
  const bool glide = sound.manner == Manner::approximant && sound.height > 0;
  if (sound.manner == Manner::vowel || glide) {
    const double height = std::clamp(sound.height, 0.0, 1.0);
    // From mid vowels upwards nothing is wider than learned; that limits are those of close vowels
    // comes later.
    const double closeness = height * std::sqrt(height);
    return MouthOpening::Target{1 + options.wider * std::max(0.0, 1 - 2 * height),
                                (1 - closeness) / options.open + closeness / options.close};
  }
  if (has_teeth_together(sound)) return MouthOpening::Target{1, 1 / options.teeth};
  if (sound.closure > 0) return MouthOpening::Target{};  // P, F: lips have their own to do
  return std::nullopt;
}

// What the opening of the jaw is multiplied by.
double share_of(const MouthOpening::Target& wish, double amount, double style, double jaw) {
  const double wider = 1 + amount * (wish.wider - 1);
  const double x = wider * std::max(jaw, 0.0) * wish.narrow / style;
  // Nearly 1 far below the limit, limit / opening far above, without a corner.
  const double narrow = 1 / std::sqrt(std::sqrt(1 + x * x * x * x));
  return wider * (1 + std::min(amount, 1.0) * (narrow - 1));
}

}  // namespace

MouthOpening::MouthOpening(const Script& script, const OpeningOptions& options)
    : options_(options) {
  for (const Phone& phone : script.phones) {
    const auto sounds = phone_features(phone.label);
    const double part = phone.duration() / double(std::max<std::size_t>(sounds.size(), 1));
    for (std::size_t i = 0; i < sounds.size(); ++i) {
      const double start = phone.start + double(i) * part;
      if (const auto wish = wish_of(sounds[i], options_)) then(start, start + part, *wish);
    }
  }
  turns_.push_back({end_ + options_.held, {}});
}

// What has no wish takes the next sound's shape, or keeps the last one's; between two wishes the
// way is shared.
void MouthOpening::then(double start, double end, const Target& wish) {
  const bool from = !turns_.empty() && turns_.back().after.any();
  const double kept = end_ + options_.held, early = start - options_.held;
  if (from && wish.any()) {
    if (kept < early) turns_.push_back({kept, {}});
    turns_.push_back({kept < early ? early : (end_ + start) / 2, wish});
  } else {
    turns_.push_back({from ? std::min(kept, start) : std::max(end_, early), wish});
  }
  end_ = end;
}

MouthOpening::Target MouthOpening::operator()(double time) const {
  const double half = options_.turn / 2;
  auto turn = std::upper_bound(turns_.begin(), turns_.end(), time - half,
                               [](double seconds, const Turn& t) { return seconds < t.centre; });
  Target before = turn == turns_.begin() ? Target{} : std::prev(turn)->after;
  Target wish = before;
  for (; turn != turns_.end() && turn->centre < time + half; ++turn) {
    const double done = raised_step((time - turn->centre) / options_.turn + 0.5);
    wish.wider += done * (turn->after.wider - before.wider);
    wish.narrow += done * (turn->after.narrow - before.narrow);
    before = turn->after;
  }
  return wish;
}

std::size_t open_mouth(const MouthOpening& opening, double amount, double style, Signal& signal) {
  if (!(amount > 0) || !(style > 0)) return 0;
  std::size_t changed = 0;
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    if (fap_of_channel(signal.names[c]) != 3) continue;
    for (std::size_t i = 0; i < signal.frames(); ++i) {
      double& jaw = signal.at(i, c);
      const MouthOpening::Target wish = opening(signal.time(i));
      if (!wish.any() || !(jaw > 0)) continue;
      jaw *= share_of(wish, amount, style, jaw);
      ++changed;
    }
  }
  return changed;
}

}  // namespace animeme::dam
