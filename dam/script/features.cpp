#include "dam/script/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dam/script/ipa_letters_internal.h"
#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

// What a step of each feature is worth. Found by hand so that the nearest phones of the letters of
// the chart have the visemes of dam/script/phoneme_scripts.md, section 3; tests/dam/ipa_test.cpp
// holds them.
constexpr double kOfClosure = 4, kOfRounding = 2, kOfVowelRounding = 2.5, kOfHeight = 1.5,
                 kOfSpreading = 0.8, kOfBackness = 0.5, kOfPlace = 0.5, kOfRhotic = 1,
                 kOfNasal = 0.3, kOfLateral = 0.6, kOfTeeth = 0.8, kOfVoice = 0.1;
constexpr double kVowelToGlide = 0.4, kVowelToConsonant = 5;
// What a phone that moves is further away from a sound that does not.
constexpr double kOfMoving = 0.2;

// By Place: how far from the lips. Steps are small where they show.
constexpr double kDepth[] = {0, 1, 2, 3, 3.5, 4, 4.3, 6, 7, 7.5, 9, 9.5};
// By Manner: how far the tongue leaves the way open.
constexpr double kOpening[] = {1, 0, 0.25, 0.1, 0.1, 0.5, 0.6, 0.6, 0.8};

bool is_vowel(const Features& f) { return f.manner == Manner::vowel; }

// j w ɥ ɹ: the way into a vowel.
bool is_glide(const Features& f) {
  return f.manner == Manner::approximant && (f.height > 0 || f.backness > 0);
}

// Teeth: 0 apart, 1 together (s), 2 together and pushed forward (ʃ).
int teeth(const Features& f) {
  if (f.manner != Manner::fricative && f.manner != Manner::affricate) return 0;
  if (f.place == Place::alveolar) return 1;
  return f.place > Place::alveolar && f.place < Place::palatal ? 2 : 0;
}

double vowel_distance(const Features& a, const Features& b) {
  // Lips are spread the more the further in front a vowel is, and not if they are round.
  const double round_a = std::max(a.rounding, 0.0), round_b = std::max(b.rounding, 0.0);
  const bool spread = round_a == 0 && round_b == 0;
  return kOfVowelRounding * std::abs(round_a - round_b) +
         kOfHeight * std::abs(a.height - b.height) +
         (spread ? kOfSpreading : kOfBackness) * std::abs(a.backness - b.backness) +
         (a.rhotic != b.rhotic ? kOfRhotic / 2 : 0);
}

double consonant_distance(const Features& a, const Features& b) {
  const auto differ = [&](Manner manner) { return (a.manner == manner) != (b.manner == manner); };
  const int apart = std::abs(teeth(a) - teeth(b));
  return kOfClosure * std::abs(a.closure - b.closure) +
         kOfRounding * std::abs(a.rounding - b.rounding) +
         kOfPlace * std::abs(kDepth[std::size_t(a.place)] - kDepth[std::size_t(b.place)]) +
         std::abs(kOpening[std::size_t(a.manner)] - kOpening[std::size_t(b.manner)]) +
         (differ(Manner::nasal) ? kOfNasal : 0) + (differ(Manner::lateral) ? kOfLateral : 0) +
         (a.rhotic != b.rhotic ? kOfRhotic : 0) + kOfTeeth * (apart > 1 ? 1.5 : apart) +
         (a.voiced != b.voiced ? kOfVoice : 0);
}

struct PhoneSounds {
  std::string_view label;
  std::array<Features, 2> sounds;
  std::size_t count = 0;
};

// Of PhoneInfo::ipa.
std::vector<PhoneSounds> all_sounds() {
  std::vector<PhoneSounds> all;
  for (const PhoneInfo& phone : phones()) {
    PhoneSounds& row = all.emplace_back(PhoneSounds{phone.label, {}, 0});
    for (std::string_view rest = phone.ipa; !rest.empty() && row.count < 2;) {
      const IpaLetter* letter = find_ipa_letter(take_code_point(rest));
      if (letter != nullptr) row.sounds[row.count++] = letter->features;
    }
  }
  return all;
}

const std::vector<PhoneSounds>& phone_sounds() {
  static const std::vector<PhoneSounds> all = all_sounds();
  return all;
}

// e and o are no phone by themselves; they are where EY and OW begin.
bool may_stand_still(const PhoneSounds& phone) {
  return phone.count == 1 || phone.label == "EY" || phone.label == "OW";
}

bool moves(const Features& sound) { return sound.manner == Manner::affricate; }

constexpr std::string_view kPlaces[] = {"bilabial",  "labiodental",  "dental",         "alveolar",
                                        "retroflex", "postalveolar", "alveolopalatal", "palatal",
                                        "velar",     "uvular",       "pharyngeal",     "glottal"};
constexpr std::string_view kManners[] = {"vowel",     "stop",  "affricate", "nasal",      "tap",
                                         "fricative", "trill", "lateral",   "approximant"};

std::string_view height_name(double height) {
  constexpr std::string_view kNames[] = {"open",      "near-open",  "open-mid", "mid",
                                         "close-mid", "near-close", "close"};
  constexpr double kBelow[] = {0.1, 0.25, 0.4, 0.56, 0.75, 0.92};
  std::size_t i = 0;
  while (i < std::size(kBelow) && height >= kBelow[i]) ++i;
  return kNames[i];
}

}  // namespace

double lip_distance(const Features& a, const Features& b) {
  const bool vowel_a = is_vowel(a), vowel_b = is_vowel(b);
  if (vowel_a && vowel_b) return vowel_distance(a, b);
  if (!vowel_a && !vowel_b) return consonant_distance(a, b);
  if (is_glide(vowel_a ? b : a)) return kVowelToGlide + vowel_distance(a, b);
  return kVowelToConsonant + kOfClosure * std::abs(a.closure - b.closure) +
         kOfRounding * std::abs(a.rounding - b.rounding);
}

std::span<const Features> phone_features(std::string_view label) {
  for (const PhoneSounds& phone : phone_sounds()) {
    if (phone.label == label) return std::span(phone.sounds).first(phone.count);
  }
  return {};
}

std::string_view nearest_phone(const Features& sound) {
  if (moves(sound)) return sound.voiced ? "JH" : "CH";
  std::string_view best;
  double least = 0;
  for (const PhoneSounds& phone : phone_sounds()) {
    if (!may_stand_still(phone) || phone.count == 0) continue;
    // A consonant is never nearest to a vowel, nor vice versa; replacements are another question.
    if (is_vowel(phone.sounds[0]) != is_vowel(sound)) continue;
    const double distance =
        lip_distance(sound, phone.sounds[0]) + (phone.count > 1 ? kOfMoving : 0);
    if (best.empty() || distance < least) {
      best = phone.label;
      least = distance;
    }
  }
  return best;
}

std::string describe(const Features& sound) {
  const std::string rounded = sound.rounding >= 0.25 ? " rounded" : "";
  if (is_vowel(sound)) {
    const std::string_view where = sound.backness < 0.36   ? " front"
                                   : sound.backness < 0.64 ? " central"
                                                           : " back";
    return std::string(height_name(sound.height)) + std::string(where) +
           (sound.rhotic ? " rhotic" : "") + rounded + " vowel";
  }
  return (sound.voiced ? "voiced" : "voiceless") + rounded + " " +
         std::string(kPlaces[std::size_t(sound.place)]) + " " +
         std::string(kManners[std::size_t(sound.manner)]);
}

}  // namespace animeme::dam
