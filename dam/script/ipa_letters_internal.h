// Letters, marks and spellings of dam/script/ipa.h. Internal; may change at any time.
#pragma once

#include <span>
#include <string_view>

#include "dam/script/features.h"

namespace animeme::dam {

/// A letter of IPA with what it means by itself.
struct IpaLetter {
  char32_t letter;
  Features features;
};

/// nullptr: no letter of IPA.
const IpaLetter* find_ipa_letter(char32_t letter);

/// What a mark does to the letter before it.
enum class IpaMark : unsigned char {
  none,        ///< nothing that lips show: stress, tone, nasality, releases
  lengthened,  ///< no feature, but it distinguishes some vowels of English
  labialised,  ///< the lips are rounded as the sound ends
  more_rounded,
  less_rounded,
  raised,
  lowered,
  advanced,
  retracted,
  centralised,
  voiceless,
  voiced,
  non_syllabic,  ///< the glide of a diphthong
  rhotic,
};

/// nullptr: neither a mark nor a combining character.
const IpaMark* find_ipa_mark(char32_t mark);

/// X-SAMPA for a letter or a mark; several of them may begin a text, the longest counts.
struct XSampa {
  std::u32string_view text;
  char32_t ipa;
};

/// Those that differ from IPA (its lower-case letters are the same).
std::span<const XSampa> x_sampa();

/// The letter without its accent, of those that Unicode composes; itself of all others.
char32_t without_accent(char32_t letter);

}  // namespace animeme::dam
