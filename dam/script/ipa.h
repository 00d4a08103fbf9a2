/// @file
/// From the International Phonetic Alphabet to the 41 phones that models know.
///
/// What counts is what the lips do: place, manner and rounding, in this order. Front rounded
/// vowels become rounded ones (y -> UW), the uvular r of French and German has no lip gesture
/// (-> G, not R), bilabial fricatives close like stops (β -> B), glottals and pharyngeals follow
/// the vowel (-> HH). Where ARPAbet has one phone for an affricate or a diphthong (tʃ -> CH,
/// aɪ -> AY) it is used, else there are two phones (ts -> T S).
///
/// X-SAMPA is accepted in the same strings (its lower-case letters are those of IPA, and IPA has
/// no upper-case ones), and so are the spellings of espeak-ng and of the Montreal aligner's IPA
/// dictionaries (aw, ej, tʃʰ). Source: dam/script/phoneme_scripts.md, section 3.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::dam {

/// One ARPAbet phone of an IPA string, with its part of the time.
struct IpaPhone {
  std::string_view label;  ///< one of dam/script/phones.h, static storage; never SIL
  double share = 1;        ///< of the duration of the whole string, > 0; all add up to 1

  friend bool operator==(const IpaPhone&, const IpaPhone&) = default;
};

/// The phones of one segment (one event of a voice, one label of an aligner), longest match
/// first. Stress, length, tone, tie bars and diacritics are dropped, except where they change
/// the lips: long ɜː is ER but short ɜ is AX, Czech r̝ is ZH, ʷ after a consonant adds a W.
///
/// Empty if the text has no letter at all: a lone modifier belongs to the sound before it.
/// Errors: not_found (a letter that is in no table, named in the message), out_of_range (more
/// than `most_bytes`: not one segment; a word may have more).
Result<std::vector<IpaPhone>> parse_ipa(std::string_view text, std::size_t most_bytes = 64);

}  // namespace animeme::dam
