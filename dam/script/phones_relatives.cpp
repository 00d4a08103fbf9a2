// The table of dam/script/phones.h. Shares: a diphthong stays a little longer on its open half;
// affricates are closed for two fifths.
#include <algorithm>
#include <iterator>

#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

struct RelativesText {
  std::string_view label;
  /// Separated by blanks. "AA:55:UW": AA for 55 % of the time, then UW; "*": kNextVowel.
  std::string_view alternatives;
};

constexpr RelativesText kRelatives[] = {
    // SIL: lips together and at rest, so the nearest are the sounds made with closed lips.
    {"SIL", "M B P"},
    // AA: the other open unrounded vowels; AO as open but rounded; AY starts here.
    {"AA", "AH AE AO AY"},
    // AE: the next more closed front vowel, then the open ones.
    {"AE", "EH AA AH EY"},
    // AH: its unstressed twin, then a little more open, then a little more spread.
    {"AH", "AX AA EH AE"},
    // AO: OW starts with it; else an open mouth that rounds.
    {"AO", "OW AA:50:UW AA UH"},
    // AW: a glide from open to rounded.
    {"AW", "AA:55:UW AA:55:UH AH:55:UW AE:55:UW AA:55:W OW AA AH"},
    // AX: a short half-open vowel without gesture.
    {"AX", "AH EH IH UH"},
    // AY: a glide from open to spread.
    {"AY", "AA:55:IY AA:55:IH AH:55:IY AE:55:IY AH:55:IH AE AA EY"},
    // B: same closure; F and V at least raise the lower lip.
    {"B", "P M V F"},
    // CH: same protrusion; T then R keeps teeth and rounding in turn.
    {"CH", "JH T:40:SH SH ZH T:40:R S"},
    // D: same place, the other voicing, then nasal, fricative, lateral.
    {"D", "T N Z L"},
    // DH: same place; then alveolars, which show the tongue less.
    {"DH", "TH D L Z T"},
    // EH: neighbours in opening, both unrounded.
    {"EH", "AE EY AX IH"},
    // ER: a vowel opening with the lips of R; R alone; a weakly rounded vowel.
    {"ER", "AX:35:R AH:35:R R UH AH EH"},
    // EY: a glide from half open to spread.
    {"EY", "EH:50:IY EH:50:IH AE:50:IY AE:50:IH EH IH IY"},
    // F: same contact; TH shows the teeth over a low lip; a closure is further off.
    {"F", "V TH P B"},
    // G: velars have neutral lips; so have HH and N.
    {"G", "K NG HH N D"},
    // HH: breath through the mouth of the vowel that follows; else a neutral mouth.
    {"HH", "* AX AH EH K G"},
    // IH: the same spread, less open; then more open.
    {"IH", "IY EH Y AX"},
    // IY: the same spread; EY ends here.
    {"IY", "IH Y EY EH"},
    // JH: same protrusion; D then R keeps teeth and rounding in turn.
    {"JH", "CH D:40:ZH ZH SH D:40:R Z"},
    // K: velars have neutral lips; so have HH and N.
    {"K", "G NG HH N T"},
    // L: tongue behind the teeth, lips neutral.
    {"L", "N D T DH"},
    // M: same closure; V and F at least raise the lower lip.
    {"M", "B P V F"},
    // N: same place, lips neutral.
    {"N", "D T L NG"},
    // NG: velar with neutral lips; N is as neutral.
    {"NG", "G K N D"},
    // OW: a glide from open rounded to closed rounded.
    {"OW", "AO:50:UW AO:50:UH AH:40:UW AO:50:W AO UW UH"},
    // OY: a glide from rounded to spread.
    {"OY", "AO:50:IY AO:50:IH OW:50:IY OW:50:IH AO:50:EY UW:50:IY AO OW"},
    // P: same closure; F and V at least raise the lower lip.
    {"P", "B M F V"},
    // R: the vowel of the same shape, then the rounded glide, then a weak rounding.
    {"R", "ER W UH L"},
    // S: same place and opening, then the stops, teeth nearly together.
    {"S", "Z T D N"},
    // SH: same protrusion and teeth; S then R keeps them in turn.
    {"SH", "CH JH ZH S:50:R S Z"},
    // T: same place, the other voicing, then nasal, fricative, lateral.
    {"T", "D N S L"},
    // TH: same place; then alveolars, which show the tongue less.
    {"TH", "DH T S L D"},
    // UH: the same rounding, tighter; OW ends here.
    {"UH", "UW OW W AX"},
    // UW: the same rounding, laxer; the glide made with it.
    {"UW", "UH W OW AO"},
    // V: same contact; DH shows the teeth over a low lip; a closure is further off.
    {"V", "F DH B P"},
    // W: the vowel of the same rounding; R is the weaker one.
    {"W", "UW UH OW R"},
    // Y: the vowel of the same spread; velars are at least neutral.
    {"Y", "IY IH EY G K"},
    // Z: same place and opening, then the stops, teeth nearly together.
    {"Z", "S D T N"},
    // ZH: same protrusion and teeth; Z then R keeps them in turn.
    {"ZH", "JH SH CH Z:50:R Z S"},
};

struct RelativesRow {
  std::string_view label;
  std::array<Relative, 8> alternatives{};
  std::size_t count = 0;
};

constexpr Relative relative(std::string_view text) {
  const std::string_view first = text.substr(0, text.find(':'));
  if (text == first) return {{{{text == "*" ? kNextVowel : text, 1.0}, {}}}, 1};
  const std::string_view digits = text.substr(first.size() + 1, 2);
  const double share = (10 * (digits[0] - '0') + digits[1] - '0') / 100.0;
  return {{{{first, share}, {text.substr(first.size() + 4), 1.0 - share}}}, 2};
}

constexpr auto kRows = [] {
  std::array<RelativesRow, std::size(kRelatives)> rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].label = kRelatives[i].label;
    for (std::string_view rest = kRelatives[i].alternatives; !rest.empty();) {
      const std::string_view text = rest.substr(0, rest.find(' '));
      rows[i].alternatives[rows[i].count++] = relative(text);
      rest.remove_prefix(std::min(text.size() + 1, rest.size()));
    }
  }
  return rows;
}();

}  // namespace

std::span<const Relative> phone_relatives(std::string_view label) {
  const auto row = std::find_if(kRows.begin(), kRows.end(), [&](const RelativesRow& candidate) {
    return candidate.label == label;
  });
  if (row == kRows.end()) return {};
  return std::span(row->alternatives).first(row->count);
}

}  // namespace animeme::dam
