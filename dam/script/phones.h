/// @file
/// The phones of the models: ARPAbet labels, their MPEG-4 visemes, their effect on the lips, and
/// their replacements.
///
/// The set is the 39 phones of the CMU pronouncing dictionary, AX (the unstressed vowel of
/// "sofa") and SIL (silence): 41 labels. Labels of other alphabets are mapped to it by
/// dam/script/ipa.h. Source: dam/script/phoneme_scripts.md, section 3; classes:
/// dam/lipsync.md, section 2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace animeme::dam {

/// Phones with the same effect on the lips of their neighbours. The numbers are part of the model
/// file format: never reorder, only append.
enum class PhoneClass : std::uint8_t {
  silence = 0,         ///< SIL
  bilabial = 1,        ///< P B M
  labiodental = 2,     ///< F V
  dental = 3,          ///< TH DH
  alveolar = 4,        ///< T D N L S Z
  velar = 5,           ///< K G NG HH Y: no lip gesture of their own
  postalveolar = 6,    ///< CH JH SH ZH
  rounded_glide = 7,   ///< R ER W
  open_vowel = 8,      ///< AA AO AH AY AW
  mid_vowel = 9,       ///< EH AE EY AX
  close_front = 10,    ///< IH IY
  rounded_vowel = 11,  ///< UH UW OW OY
};

inline constexpr std::size_t kPhoneClassCount = 12;  ///< values of PhoneClass
inline constexpr std::size_t kPhoneCount = 41;       ///< labels, SIL included

/// Properties of one phone. All views point to static storage.
struct PhoneInfo {
  std::string_view label;     ///< upper-case ARPAbet, "SIL" for silence
  std::string_view ipa;       ///< UTF-8; empty for SIL
  std::uint8_t viseme_start;  ///< MPEG-4 viseme 0..14 at the start of the phone
  std::uint8_t viseme_end;    ///< and at its end; differs for diphthongs only
  PhoneClass phone_class;     ///< its effect on neighbours
  bool vowel;                 ///< can carry a syllable, ER and diphthongs included
  bool bilabial;              ///< both lips must touch: P B M
  bool labiodental;           ///< the lower lip must touch the upper teeth: F V
  bool rounded;               ///< the lips protrude at some point of the phone
};

/// All phones; SIL first, then by alphabet. The order is stable.
std::span<const PhoneInfo, kPhoneCount> phones();

/// The phone with exactly this label (as in PhoneInfo), nullptr if there is none.
const PhoneInfo* find_phone(std::string_view label);

/// "bilabial" etc.: one word for people and files. Empty for values outside the enumeration.
std::string_view phone_class_name(PhoneClass phone_class);

/// The ARPAbet label of an aligner's spelling, empty if it is none.
///
/// Upper or lower case; a stress digit 0..3 at the end of a vowel is dropped; AXR IX UX DX NX EL EM
/// EN ENG HV Q and the closures BCL ... (TIMIT) become the nearest of the 41, and Kaldi's suffixes
/// _B _I _E _S are dropped. Every usual spelling of a pause gives SIL: nothing, `sil silence sp spn
/// nsn pau h# # _ __ epi brth <sil> <eps> <p:>` and the like. IPA and X-SAMPA are not considered;
/// see dam/script/ipa.h.
std::string_view arpabet_label(std::string_view spelling);

/// True for the pauses listed at arpabet_label().
bool is_silence_spelling(std::string_view spelling);

/// The known label with the most similar spelling, for error messages; never empty.
std::string_view nearest_label(std::string_view spelling);

// ---------------------------------------------------------------------------------------------
// Relatives: replacements of phones that a model has never seen. Small corpora lack phones (the
// GRID sentences have no ER HH NG OY SH UH ZH), so this is the normal case.
//
// Each label has an ordered list of alternatives, nearest first; use the first one all of whose
// parts the model knows. It contains all other phones, so that a model of few sounds speaks
// everything. An alternative is one phone for the whole duration, or two phones in sequence with
// their shares of it: for diphthongs, affricates and ER, which is a schwa and an r. The order is
// that of lip_distance() (dam/script/features.h): SH and ZH are rounded like CH and JH. The first
// alternative of HH and NG is an adjacent vowel.
// ---------------------------------------------------------------------------------------------

/// In place of a label in RelativePart: the phone has no mouth shape of its own and takes that in
/// which the next vowel of the script begins (if there is none before the next silence, skip this
/// alternative).
inline constexpr std::string_view kNextVowel = "<next vowel>";

/// The same for the previous vowel, as it ends.
inline constexpr std::string_view kVowelBefore = "<vowel before>";

/// One piece of an alternative.
struct RelativePart {
  std::string_view label;  ///< one of the 41, kNextVowel or kVowelBefore
  double share = 1;        ///< of the duration of the phone that is replaced, 0..1
};

/// An alternative: `count` parts in time order, whose shares add up to 1.
struct Relative {
  std::array<RelativePart, 2> part;  ///< the first `count` are used
  std::size_t count = 1;             ///< 1 or 2

  /// The parts that are used.
  std::span<const RelativePart> parts() const { return {part.data(), count}; }
};

/// The alternatives for `label`, nearest first; empty for SIL and unknown labels.
std::span<const Relative> phone_relatives(std::string_view label);

}  // namespace animeme::dam
