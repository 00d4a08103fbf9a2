// The tables of ipa_letters_internal.h: one row per letter of the chart, the rest refers to
// letters.
#include "dam/script/ipa_letters_internal.h"

#include <algorithm>
#include <iterator>

namespace animeme::dam {
// Names of features are words that other files of this library have, too.
namespace ipa_tables {

using enum Manner;
using enum Place;

constexpr bool kVoiceless = false, kVoiced = true;

constexpr Features consonant(Place place, Manner manner, bool is_voiced, double rounding = 0) {
  Features f;
  f.manner = manner;
  f.place = place;
  f.voiced = is_voiced;
  f.closure = place == bilabial ? 1 : place == labiodental ? 0.5 : 0;
  f.rounding = rounding;
  f.rhotic = manner == trill && place == alveolar;
  return f;
}

// The lips come near each other and leave a slit.
constexpr Features slit(bool is_voiced) {
  Features f = consonant(bilabial, fricative, is_voiced);
  f.closure = 0.85;
  return f;
}

constexpr Features vowel_at(double height, double backness, double rounding = 0,
                            bool is_rhotic = false) {
  return {vowel, glottal, true, is_rhotic, 0, rounding, height, backness};
}

// A consonant that is the way into or out of a vowel.
constexpr Features glide(Place place, Manner manner, bool is_voiced, double rounding, double height,
                         double backness, bool is_rhotic = false) {
  return {manner, place, is_voiced, is_rhotic, 0, rounding, height, backness};
}

constexpr double kClose = 1, kNearClose = 0.83, kCloseMid = 0.67, kMid = 0.45, kOpenMid = 0.33,
                 kNearOpen = 0.17, kOpen = 0, kFront = 0, kCentral = 0.5, kBack = 1, kRound = 1;

constexpr IpaLetter kLetters[] = {
    {U'p', consonant(bilabial, stop, kVoiceless)},
    {U'b', consonant(bilabial, stop, kVoiced)},
    {U'ɓ', consonant(bilabial, stop, kVoiced)},
    {U'ʘ', consonant(bilabial, stop, kVoiceless)},
    {U'm', consonant(bilabial, nasal, kVoiced)},
    {U'ʙ', consonant(bilabial, trill, kVoiced)},
    {U'ɸ', slit(kVoiceless)},
    {U'Φ', slit(kVoiceless)},  // Greek letters that espeak-ng writes for those of IPA
    {U'β', slit(kVoiced)},
    {U'ɱ', consonant(labiodental, nasal, kVoiced)},
    {U'ⱱ', consonant(labiodental, tap, kVoiced)},
    {U'f', consonant(labiodental, fricative, kVoiceless)},
    {U'v', consonant(labiodental, fricative, kVoiced)},
    {U'ʋ', consonant(labiodental, approximant, kVoiced)},
    {U'θ', consonant(dental, fricative, kVoiceless)},
    {U'ð', consonant(dental, fricative, kVoiced)},
    {U't', consonant(alveolar, stop, kVoiceless)},
    {U'd', consonant(alveolar, stop, kVoiced)},
    {U'ɗ', consonant(alveolar, stop, kVoiced)},
    {U'ǀ', consonant(alveolar, stop, kVoiceless)},
    {U'ǃ', consonant(postalveolar, stop, kVoiceless)},
    {U'ǂ', consonant(postalveolar, stop, kVoiceless)},
    {U'n', consonant(alveolar, nasal, kVoiced)},
    {U'ɾ', consonant(alveolar, tap, kVoiced)},
    {U'r', consonant(alveolar, trill, kVoiced)},
    {U's', consonant(alveolar, fricative, kVoiceless)},
    {U'z', consonant(alveolar, fricative, kVoiced)},
    {U'l', consonant(alveolar, lateral, kVoiced)},
    {U'ɫ', consonant(alveolar, lateral, kVoiced)},
    {U'ɬ', consonant(alveolar, lateral, kVoiceless)},
    {U'ɮ', consonant(alveolar, lateral, kVoiced)},
    {U'ɺ', consonant(alveolar, lateral, kVoiced)},
    {U'ǁ', consonant(alveolar, lateral, kVoiceless)},
    // The r of English rounds the lips a little; its vowel is that of "bird".
    {U'ɹ', glide(alveolar, approximant, kVoiced, 0.3, kMid, kCentral, true)},
    {U'ɻ', glide(retroflex, approximant, kVoiced, 0.3, kMid, kCentral, true)},
    {U'ʈ', consonant(retroflex, stop, kVoiceless)},
    {U'ɖ', consonant(retroflex, stop, kVoiced)},
    {U'ɳ', consonant(retroflex, nasal, kVoiced)},
    {U'ɽ', consonant(retroflex, tap, kVoiced)},
    {U'ɭ', consonant(retroflex, lateral, kVoiced)},
    {U'ʂ', consonant(retroflex, fricative, kVoiceless, 0.2)},
    {U'ʐ', consonant(retroflex, fricative, kVoiced, 0.2)},
    {U'ʃ', consonant(postalveolar, fricative, kVoiceless, 0.4)},
    {U'ʒ', consonant(postalveolar, fricative, kVoiced, 0.4)},
    {U'ʧ', consonant(postalveolar, affricate, kVoiceless, 0.4)},
    {U'ʤ', consonant(postalveolar, affricate, kVoiced, 0.4)},
    {U'ɧ', consonant(postalveolar, fricative, kVoiceless, 0.5)},
    {U'ɕ', consonant(alveolopalatal, fricative, kVoiceless)},
    {U'ʑ', consonant(alveolopalatal, fricative, kVoiced)},
    {U'ʨ', consonant(alveolopalatal, affricate, kVoiceless)},
    {U'ʥ', consonant(alveolopalatal, affricate, kVoiced)},
    // Made nearer to the teeth than c and j in the languages that have them.
    {U'ɲ', consonant(alveolopalatal, nasal, kVoiced)},
    {U'ʎ', consonant(alveolopalatal, lateral, kVoiced)},
    {U'c', consonant(palatal, stop, kVoiceless)},
    {U'ɟ', consonant(palatal, stop, kVoiced)},
    {U'ʄ', consonant(palatal, stop, kVoiced)},
    // Spread as i.
    {U'ç', glide(palatal, fricative, kVoiceless, -0.3, kClose, kFront)},
    {U'ʝ', glide(palatal, fricative, kVoiced, -0.3, kClose, kFront)},
    {U'j', glide(palatal, approximant, kVoiced, -0.3, kClose, kFront)},
    {U'ɥ', glide(palatal, approximant, kVoiced, kRound, kClose, kFront)},
    {U'k', consonant(velar, stop, kVoiceless)},
    {U'g', consonant(velar, stop, kVoiced)},
    {U'ɡ', consonant(velar, stop, kVoiced)},
    {U'ɠ', consonant(velar, stop, kVoiced)},
    {U'ŋ', consonant(velar, nasal, kVoiced)},
    {U'x', consonant(velar, fricative, kVoiceless)},
    {U'ɣ', consonant(velar, fricative, kVoiced)},
    {U'ɰ', consonant(velar, approximant, kVoiced)},
    {U'ʟ', consonant(velar, lateral, kVoiced)},
    {U'w', glide(velar, approximant, kVoiced, kRound, kClose, kBack)},
    {U'ʍ', glide(velar, approximant, kVoiceless, kRound, kClose, kBack)},
    {U'q', consonant(uvular, stop, kVoiceless)},
    {U'ɢ', consonant(uvular, stop, kVoiced)},
    {U'ʛ', consonant(uvular, stop, kVoiced)},
    {U'ɴ', consonant(uvular, nasal, kVoiced)},
    {U'χ', consonant(uvular, fricative, kVoiceless)},
    {U'ʁ', consonant(uvular, fricative, kVoiced)},
    {U'ʀ', consonant(uvular, trill, kVoiced)},
    {U'ħ', consonant(pharyngeal, fricative, kVoiceless)},
    {U'ʕ', consonant(pharyngeal, fricative, kVoiced)},
    {U'ʜ', consonant(pharyngeal, fricative, kVoiceless)},
    {U'ʢ', consonant(pharyngeal, fricative, kVoiced)},
    {U'ʡ', consonant(pharyngeal, stop, kVoiceless)},
    {U'ʔ', consonant(glottal, stop, kVoiceless)},
    {U'h', consonant(glottal, fricative, kVoiceless)},
    {U'ɦ', consonant(glottal, fricative, kVoiced)},
    {U'i', vowel_at(kClose, kFront)},
    {U'y', vowel_at(kClose, kFront, kRound)},
    {U'ɨ', vowel_at(kClose, kCentral)},
    {U'ʉ', vowel_at(kClose, kCentral, kRound)},
    {U'ɯ', vowel_at(kClose, kBack)},
    {U'u', vowel_at(kClose, kBack, kRound)},
    {U'ɪ', vowel_at(kNearClose, 0.35)},
    {U'ɩ', vowel_at(kNearClose, 0.35)},
    {U'ʏ', vowel_at(kNearClose, 0.2, kRound)},
    {U'ᵻ', vowel_at(kNearClose, kCentral)},
    {U'ᵿ', vowel_at(kNearClose, kCentral, kRound)},
    {U'ʊ', vowel_at(kNearClose, 0.8, kRound)},
    {U'ɷ', vowel_at(kNearClose, 0.8, kRound)},
    {U'e', vowel_at(kCloseMid, kFront)},
    {U'ø', vowel_at(kCloseMid, kFront, kRound)},
    {U'ɘ', vowel_at(kCloseMid, kCentral)},
    {U'ɵ', vowel_at(kCloseMid, kCentral, kRound)},
    {U'ɤ', vowel_at(kCloseMid, kBack)},
    {U'o', vowel_at(kCloseMid, kBack, kRound)},
    {U'ə', vowel_at(kMid, kCentral)},
    {U'ɚ', vowel_at(kMid, kCentral, 0.3, true)},
    {U'ɛ', vowel_at(kOpenMid, kFront)},
    {U'ε', vowel_at(kOpenMid, kFront)},
    {U'œ', vowel_at(kOpenMid, kFront, kRound)},
    {U'ɜ', vowel_at(kOpenMid, kCentral)},
    {U'ɝ', vowel_at(kMid, kCentral, 0.3, true)},
    {U'ɞ', vowel_at(kOpenMid, kCentral, kRound)},
    // As in English, where it is nearer to the middle than the corner that the chart gives it.
    {U'ʌ', vowel_at(0.2, 0.7)},
    {U'ɔ', vowel_at(kOpenMid, kBack, kRound)},
    {U'æ', vowel_at(kNearOpen, kFront)},
    {U'ɐ', vowel_at(kNearOpen, kCentral)},
    // In most languages the one open vowel, which is in the middle.
    {U'a', vowel_at(kOpen, kCentral)},
    {U'ɶ', vowel_at(kOpen, kFront, kRound)},
    {U'ɑ', vowel_at(kOpen, kBack)},
    {U'ɒ', vowel_at(kOpen, kBack, kRound)},
    // What a nasal before a stop is written as.
    {U'ᵐ', consonant(bilabial, nasal, kVoiced)},
    {U'ⁿ', consonant(alveolar, nasal, kVoiced)},
    {U'ᵑ', consonant(velar, nasal, kVoiced)},
};

struct MarkRow {
  char32_t mark;
  IpaMark effect;
};

constexpr MarkRow kMarks[] = {
    {U'ː', IpaMark::lengthened},        {U':', IpaMark::lengthened},
    {U'ʷ', IpaMark::labialised},        {U'˞', IpaMark::rhotic},
    {U'\u0339', IpaMark::more_rounded}, {U'\u031C', IpaMark::less_rounded},
    {U'\u031D', IpaMark::raised},       {U'\u031E', IpaMark::lowered},
    {U'\u031F', IpaMark::advanced},     {U'\u0320', IpaMark::retracted},
    {U'\u0308', IpaMark::centralised},  {U'\u033D', IpaMark::centralised},
    {U'\u0325', IpaMark::voiceless},    {U'\u030A', IpaMark::voiceless},
    {U'\u032C', IpaMark::voiced},       {U'\u032F', IpaMark::non_syllabic},
};

// Marks that do not change the lips enough to matter: stress, tone, breaks, releases, espeak-ng's
// variants.
constexpr std::u32string_view kIgnored = U"ˑʰʲˠˤˀʼᵝˡʱˈˌˊˋˇˆ‿ꜜꜛ˥˦˧˨˩↓↑‖|.-;,!`'\"%=~^#[]()/*+<> ";

constexpr XSampa kXSampa[] = {
    {U"p\\", U'ɸ'},     {U"O\\", U'ʘ'},      {U"b_<", U'ɓ'},     {U"B", U'β'},
    {U"B\\", U'ʙ'},     {U"v\\", U'ʋ'},      {U"P", U'ʋ'},       {U"F", U'ɱ'},
    {U"T", U'θ'},       {U"D", U'ð'},        {U"t`", U'ʈ'},      {U"|\\", U'ǀ'},
    {U"!\\", U'ǃ'},     {U"=\\", U'ǂ'},      {U"d`", U'ɖ'},      {U"4", U'ɾ'},
    {U"n`", U'ɳ'},      {U"J", U'ɲ'},        {U"l\\", U'ɺ'},     {U"l`", U'ɭ'},
    {U"5", U'ɫ'},       {U"L", U'ʎ'},        {U"K", U'ɬ'},       {U"K\\", U'ɮ'},
    {U"|\\|\\", U'ǁ'},  {U"X", U'χ'},        {U"G", U'ɣ'},       {U"G\\", U'ɢ'},
    {U"R", U'ʁ'},       {U"R\\", U'ʀ'},      {U"M\\", U'ɰ'},     {U"L\\", U'ʟ'},
    {U"J\\", U'ɟ'},     {U"N", U'ŋ'},        {U"N\\", U'ɴ'},     {U"?", U'ʔ'},
    {U"h\\", U'ɦ'},     {U"X\\", U'ħ'},      {U"?\\", U'ʕ'},     {U"H\\", U'ʜ'},
    {U"<\\", U'ʢ'},     {U">\\", U'ʡ'},      {U"C", U'ç'},       {U"j\\", U'ʝ'},
    {U"S", U'ʃ'},       {U"s`", U'ʂ'},       {U"s\\", U'ɕ'},     {U"x\\", U'ɧ'},
    {U"Z", U'ʒ'},       {U"z`", U'ʐ'},       {U"z\\", U'ʑ'},     {U"r\\", U'ɹ'},
    {U"r`", U'ɽ'},      {U"r\\`", U'ɻ'},     {U"W", U'ʍ'},       {U"H", U'ɥ'},
    {U"I", U'ɪ'},       {U"I\\", U'ᵻ'},      {U"1", U'ɨ'},       {U"M", U'ɯ'},
    {U"E", U'ɛ'},       {U"{", U'æ'},        {U"@", U'ə'},       {U"@\\", U'ɘ'},
    {U"7", U'ɤ'},       {U"3", U'ɜ'},        {U"V", U'ʌ'},       {U"6", U'ɐ'},
    {U"A", U'ɑ'},       {U"O", U'ɔ'},        {U"Q", U'ɒ'},       {U"9", U'œ'},
    {U"3\\", U'ɞ'},     {U"&", U'ɶ'},        {U"U", U'ʊ'},       {U"Y", U'ʏ'},
    {U"2", U'ø'},       {U"8", U'ɵ'},        {U"U\\", U'ᵿ'},     {U"}", U'ʉ'},
    {U"@`", U'ɚ'},      {U"3`", U'ɝ'},       {U"_w", U'ʷ'},      {U"_O", U'\u0339'},
    {U"_c", U'\u031C'}, {U"_r", U'\u031D'},  {U"_o", U'\u031E'}, {U"_+", U'\u031F'},
    {U"_-", U'\u0320'}, {U"_\"", U'\u0308'}, {U"_x", U'\u033D'}, {U"_0", U'\u0325'},
    {U"_v", U'\u032C'}, {U"_^", U'\u032F'}};

struct ComposedLetter {
  std::u32string_view letters;
  char32_t base;
};

// Letters that carry their accent inside (Unicode NFC). ç is a letter of its own.
constexpr ComposedLetter kComposed[] = {
    {U"ãáàâāăǎåä", U'a'}, {U"ẽéèêēĕěë", U'e'}, {U"ĩíìîīĭǐï", U'i'}, {U"õóòôōŏǒö", U'o'},
    {U"ũúùûūŭǔü", U'u'},  {U"ỹýỳŷȳÿ", U'y'},   {U"ñńň", U'n'}};

}  // namespace ipa_tables

const IpaLetter* find_ipa_letter(char32_t letter) {
  const auto found = std::find_if(std::begin(ipa_tables::kLetters), std::end(ipa_tables::kLetters),
                                  [&](const IpaLetter& row) { return row.letter == letter; });
  return found == std::end(ipa_tables::kLetters) ? nullptr : found;
}

const IpaMark* find_ipa_mark(char32_t mark) {
  static constexpr IpaMark kNone = IpaMark::none;
  const auto found = std::find_if(std::begin(ipa_tables::kMarks), std::end(ipa_tables::kMarks),
                                  [&](const ipa_tables::MarkRow& row) { return row.mark == mark; });
  if (found != std::end(ipa_tables::kMarks)) return &found->effect;
  const bool combining = mark >= 0x300 && mark <= 0x36F;
  return combining || ipa_tables::kIgnored.find(mark) != ipa_tables::kIgnored.npos ? &kNone
                                                                                   : nullptr;
}

std::span<const XSampa> x_sampa() { return ipa_tables::kXSampa; }

char32_t without_accent(char32_t letter) {
  for (const ipa_tables::ComposedLetter& row : ipa_tables::kComposed) {
    if (row.letters.find(letter) != row.letters.npos) return row.base;
  }
  return letter;
}

}  // namespace animeme::dam
