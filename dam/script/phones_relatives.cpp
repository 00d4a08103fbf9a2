// Replacements of phones (dam/script/phones.h): every other phone by the distance of the lips, and
// pairs for the phones that are two sounds in sequence.
#include <algorithm>
#include <map>
#include <vector>

#include "dam/script/features.h"
#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

using Ranked = std::vector<std::pair<double, Relative>>;

constexpr std::size_t kPairs = 10;  // the nearest of them are enough: single phones follow
// A pair of phones makes two gestures where one would do.
constexpr double kOfPair = 0.15;
// A phone that moves for one that does not, or the other way round.
constexpr double kOfMovement = 0.4;

// Two sounds in turn, and how long the first one lasts. The second of an affricate is on the lips
// from its beginning.
struct InTurn {
  std::vector<Features> sounds;
  double first_share = 1;
  double first_weight = 1;
};

InTurn in_turn(const PhoneInfo& phone) {
  const auto sounds = phone_features(phone.label);
  if (phone.label == "ER") {  // a schwa and an r
    return {{phone_features("AX")[0], phone_features("R")[0]}, 0.35, 0.35};
  }
  if (sounds.size() < 2) return {{sounds.begin(), sounds.end()}, 1, 1};
  return {{sounds.begin(), sounds.end()}, phone.vowel ? 0.5 : 0.4, phone.vowel ? 0.5 : 0.25};
}

double distance(const PhoneInfo& a, const PhoneInfo& b) {
  const auto from = phone_features(a.label), to = phone_features(b.label);
  const bool affricate = (from.size() > 1 && !a.vowel) || (to.size() > 1 && !b.vowel);
  const double first = affricate ? 0.25 : 0.5;
  return first * lip_distance(from.front(), to.front()) +
         (1 - first) * lip_distance(from.back(), to.back()) +
         (from.size() != to.size() ? kOfMovement : 0);
}

// A diphthong closes, and so must its replacement.
bool moves_alike(const InTurn& parts, const Features& first, const Features& second) {
  const bool closes = parts.sounds[0].height < parts.sounds[1].height;
  return !closes || first.height < second.height;
}

void add_pairs(const PhoneInfo& phone, Ranked& ranked) {
  const InTurn parts = in_turn(phone);
  if (parts.sounds.size() < 2) return;
  Ranked pairs;
  for (const PhoneInfo& first : phones()) {
    const auto from = phone_features(first.label);
    if (from.size() != 1) continue;
    for (const PhoneInfo& second : phones()) {
      const auto to = phone_features(second.label);
      if (to.size() != 1 || first.label == phone.label || second.label == phone.label) continue;
      if (!moves_alike(parts, from[0], to[0])) continue;
      const double cost = kOfPair + parts.first_weight * lip_distance(parts.sounds[0], from[0]) +
                          (1 - parts.first_weight) * lip_distance(parts.sounds[1], to[0]);
      pairs.push_back(
          {cost, {{{{first.label, parts.first_share}, {second.label, 1 - parts.first_share}}}, 2}});
    }
  }
  const auto nearer = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(pairs.begin(), pairs.end(), nearer);
  pairs.resize(std::min(pairs.size(), kPairs));
  ranked.insert(ranked.end(), pairs.begin(), pairs.end());
}

Relative single(std::string_view label) { return {{{{label, 1.0}, {}}}, 1}; }

std::vector<Relative> relatives_of(const PhoneInfo& phone) {
  Ranked ranked;
  // Breath goes through the mouth of a vowel, and a velar nasal leaves the lips alone.
  if (phone.label == "HH") ranked = {{-2, single(kNextVowel)}, {-1, single(kVowelBefore)}};
  if (phone.label == "NG") ranked = {{-2, single(kVowelBefore)}, {-1, single(kNextVowel)}};
  for (const PhoneInfo& other : phones()) {
    if (other.label == phone.label || other.label == phones()[0].label) continue;
    ranked.push_back({distance(phone, other), single(other.label)});
  }
  add_pairs(phone, ranked);
  const auto nearer = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(ranked.begin(), ranked.end(), nearer);
  std::vector<Relative> relatives;
  for (const auto& [cost, relative] : ranked) relatives.push_back(relative);
  return relatives;
}

std::map<std::string_view, std::vector<Relative>> all_relatives() {
  std::map<std::string_view, std::vector<Relative>> all;
  for (const PhoneInfo& phone : phones().subspan(1)) all[phone.label] = relatives_of(phone);
  return all;
}

}  // namespace

std::span<const Relative> phone_relatives(std::string_view label) {
  static const auto all = all_relatives();
  const auto found = all.find(label);
  if (found == all.end()) return {};
  return found->second;
}

}  // namespace animeme::dam
