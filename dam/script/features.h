/// @file
/// Articulatory features of sounds, and the visual distance of two sounds.
///
/// Any sound of any language has a set of features; the 41 phones of the models have features, too,
/// and the nearest of them replaces the sound. The distance is that of the lips: contact and
/// rounding weigh most, then the opening of the jaw, then place as far as lips, teeth and the tip
/// of the tongue show; voicing hardly counts. The same distance selects the replacement of a phone
/// that a model does not know (phone_relatives()). Source: dam/script/phoneme_scripts.md, section
/// 3.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace animeme::dam {

/// Place of articulation, from the lips inwards.
enum class Place : std::uint8_t {
  bilabial,
  labiodental,
  dental,
  alveolar,
  retroflex,
  postalveolar,
  alveolopalatal,
  palatal,
  velar,
  uvular,
  pharyngeal,  ///< including epiglottal
  glottal,
};

/// Manner of articulation. Implosives, ejectives and clicks are stops: their lips are the same.
enum class Manner : std::uint8_t {
  vowel,
  stop,
  affricate,
  nasal,
  tap,
  fricative,
  trill,
  lateral,  ///< of any kind, including fricatives and clicks
  approximant,
};

/// One sound.
struct Features {
  Manner manner = Manner::vowel;  ///< consonants have a place, vowels and glides a height
  Place place = Place::glottal;   ///< of a consonant
  bool voiced = true;             ///< sounds with voice
  bool rhotic = false;            ///< an r, or an r-coloured vowel
  double closure = 0;             ///< 1: the lips meet; 0.5: the lower lip meets the teeth; 0: open
  double rounding = 0;            ///< 1: rounded; below 0: more spread than usual for the place
  double height = 0;              ///< of vowels and glides, 0 (open: a) to 1 (close: i)
  double backness = 0;            ///< likewise, 0 (front: i) to 1 (back: u)

  friend bool operator==(const Features&, const Features&) = default;
};

/// Visual distance of two sounds, 0 (the same) and up; p and b are 0.1 apart, i and u 2.5, t and p
/// 5. Vowels and consonants are further apart than any two of one kind, except glides (j is near
/// i).
double lip_distance(const Features& a, const Features& b);

/// The features of a phone: one sound, or two in sequence for diphthongs and affricates. Empty for
/// SIL and for anything other than the 41 labels. Static storage.
std::span<const Features> phone_features(std::string_view label);

/// The visually nearest phone of a sound. Diphthongs and affricates, which move, are not used for a
/// sound that does not, except for e (EY) and o (OW), which have no other. Static storage.
std::string_view nearest_phone(const Features& sound);

/// The phonetic description: "close front rounded vowel", "voiced bilabial stop".
std::string describe(const Features& sound);

}  // namespace animeme::dam
