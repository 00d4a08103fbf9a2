/// @file
/// Sounds by what the mouth does, and how unlike two of them look.
///
/// Any sound of any language is a bundle of features; the 41 phones that models know are bundles,
/// too, and the nearest of them is spoken for it. Distance is that of the lips: contact and
/// rounding weigh most, then how far the jaw is open, then place as far as lips, teeth and the tip
/// of the tongue show; voicing hardly counts. The same distance tells which phone stands in for one
/// that a model has never seen (phone_relatives()). Source: dam/script/phoneme_scripts.md,
/// section 3.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace animeme::dam {

/// Where the mouth is narrowest, from the lips inwards.
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
  pharyngeal,  ///< epiglottal ones, too
  glottal,
};

/// How. Implosives, ejectives and clicks are stops: their lips are the same.
enum class Manner : std::uint8_t {
  vowel,
  stop,
  affricate,
  nasal,
  tap,
  fricative,
  trill,
  lateral,  ///< of any kind, fricatives and clicks included
  approximant,
};

/// One sound.
struct Features {
  Manner manner = Manner::vowel;  ///< consonants only have a place, vowels and glides a height
  Place place = Place::glottal;   ///< of a consonant
  bool voiced = true;             ///< sounds with voice
  bool rhotic = false;            ///< an r, or a vowel that is coloured by one
  double closure = 0;             ///< 1: the lips meet; 0.5: the lower lip meets the teeth; 0: open
  double rounding = 0;            ///< 1: rounded; below 0: spread more than the place asks for
  double height = 0;              ///< of vowels and glides, 0 (open: a) to 1 (close: i)
  double backness = 0;            ///< the same, 0 (front: i) to 1 (back: u)

  friend bool operator==(const Features&, const Features&) = default;
};

/// How unlike two sounds look, 0 (the same) and up; p and b are 0.1 apart, i and u 2.5, t and p 5.
/// Vowels and consonants are further apart than any two of one kind, except glides (j is near i).
double lip_distance(const Features& a, const Features& b);

/// What a phone is made of: one sound, or two in turn for diphthongs and affricates. Empty for SIL
/// and for what is none of the 41 labels. Static storage.
std::span<const Features> phone_features(std::string_view label);

/// The phone that looks most like a sound. Diphthongs and affricates, which move, are no answer to
/// a sound that does not, but for e (EY) and o (OW), which have no other. Static storage.
std::string_view nearest_phone(const Features& sound);

/// In the words of phonetics: "close front rounded vowel", "voiced bilabial stop".
std::string describe(const Features& sound);

}  // namespace animeme::dam
