/// @file
/// Maps the International Phonetic Alphabet to the 41 phones of the models.
///
/// Every letter has a set of features, diacritics change them, and the phone whose lips look most
/// alike is used (dam/script/features.h): y is rounded like UW, ɯ and ɨ are not, the uvular r of
/// French and German does not affect the lips (G, not R), bilabial fricatives close like stops (β
/// is B). If ARPAbet has one phone for an affricate or a diphthong (tɕ: CH, aj: AY) it is used,
/// else there are two phones (ts: T S).
///
/// X-SAMPA and SAMPA are accepted in the same strings (their lower-case letters are those of IPA,
/// and IPA has no upper-case ones), and so are the spellings of espeak-ng and of the Montreal
/// aligner's IPA dictionaries (aw, ej, tʃʰ). Source: dam/script/phoneme_scripts.md, section 3.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/features.h"
#include "fap/result.h"

namespace animeme::dam {

/// One ARPAbet phone of an IPA string, with its share of the time.
struct IpaPhone {
  std::string_view label;  ///< one of dam/script/phones.h, static storage; never SIL
  double share = 1;        ///< of the duration of the whole string, > 0; all add up to 1

  friend bool operator==(const IpaPhone&, const IpaPhone&) = default;
};

/// The phones of one segment (one event of a TTS engine, one label of an aligner). Stress, length,
/// tone, tie bars and diacritics are dropped, except where they change the lips: long ɜː is ER but
/// short ɜ is AX, Czech r̝ is ZH, ʷ after a consonant adds a W, ˞ after a vowel an R.
///
/// Empty if the text has no letter at all: a lone modifier belongs to the previous sound. Errors:
/// not_found (an unknown letter, named in the message), out_of_range (more than `most_bytes`: not
/// one segment; a word may have more).
Result<std::vector<IpaPhone>> parse_ipa(std::string_view text, std::size_t most_bytes = 64);

/// X-SAMPA in letters of the IPA, stress, length and ties included; what is no X-SAMPA stays.
std::string x_sampa_to_ipa(std::string_view text);

/// A phone of an IPA string, with the sound that it replaces.
struct IpaSound {
  std::string_view label;       ///< as IpaPhone::label
  bool exact = false;           ///< the string has exactly this phone; else it is the nearest
  std::vector<Features> heard;  ///< the sound in the string; two for a diphthong or an affricate
};

/// The same with the sounds. Consecutive duplicates are merged. Errors as parse_ipa().
Result<std::vector<IpaSound>> parse_ipa_sounds(std::string_view text, std::size_t most_bytes = 64);

}  // namespace animeme::dam
