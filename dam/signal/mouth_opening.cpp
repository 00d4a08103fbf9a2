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

// What a gap is multiplied by.
double share_of(const MouthOpening::Target& wish, double amount, double style, double gap) {
  const double wider = 1 + amount * (wish.wider - 1);
  const double x = wider * std::max(gap, 0.0) * wish.narrow / style;
  // Nearly 1 far below the limit, limit / gap far above, without a corner.
  const double narrow = 1 / std::sqrt(std::sqrt(1 + x * x * x * x));
  return wider * (1 + std::min(amount, 1.0) * (narrow - 1));
}

// One place along the lips: inner channels, outer ones.
struct LipPlace {
  std::optional<std::size_t> upper, lower, outer_upper, outer_lower;
};

std::optional<std::size_t> find_channel(const Signal& signal, int fap) {
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    if (fap_of_channel(signal.names[c]) == fap) return c;
  }
  return std::nullopt;
}

// Each lip has as much of the change as of the gap; one that is drawn over the other has none.
bool move_lips(const LipPlace& place, double share, const ClosureOptions& follow, std::size_t frame,
               Signal& signal) {
  const double upper = signal.at(frame, *place.upper), lower = signal.at(frame, *place.lower);
  const double gap = -(upper + lower), away = std::max(-upper, 0.0) + std::max(-lower, 0.0);
  if (!(gap > 0)) return false;
  const double factor = gap * (share - 1) / away;
  const double up = factor * std::min(upper, 0.0), low = factor * std::min(lower, 0.0);
  signal.at(frame, *place.upper) += up;
  signal.at(frame, *place.lower) += low;
  if (place.outer_upper) signal.at(frame, *place.outer_upper) += follow.upper_follow * up;
  if (place.outer_lower) signal.at(frame, *place.outer_lower) += follow.lower_follow * low;
  return true;
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

std::size_t open_mouth(const MouthOpening& opening, double amount, double style, Signal& signal,
                       const ClosureOptions& follow) {
  const auto lips = inner_lip_channels(signal.names);
  if (!lips || !(amount > 0) || !(style > 0)) return 0;
  constexpr int kFaps[][4] = {{4, 5, 51, 52}, {8, 10, 55, 57}, {9, 11, 56, 58}};
  std::vector<LipPlace> places;
  for (const auto& faps : kFaps) {
    const LipPlace place{find_channel(signal, faps[0]), find_channel(signal, faps[1]),
                         find_channel(signal, faps[2]), find_channel(signal, faps[3])};
    if (place.upper && place.lower) places.push_back(place);
  }
  const auto jaw = find_channel(signal, 3);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const MouthOpening::Target wish = opening(signal.time(i));
    if (!wish.any()) continue;
    const double share = share_of(wish, amount, style, inner_gap(signal, i, *lips));
    bool moved = false;
    for (const LipPlace& place : places) moved |= move_lips(place, share, follow, i, signal);
    if (jaw && signal.at(i, *jaw) > 0) {
      signal.at(i, *jaw) *= share;
      moved = true;
    }
    changed += moved ? 1 : 0;
  }
  return changed;
}

}  // namespace animeme::dam
