// The table of dam/script/phones.h, one line an alternative. Shares: a diphthong stays a little
// longer on its open half; affricates are closed for two fifths.
#include <algorithm>
#include <iterator>

#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

struct RelativesRow {
  std::string_view label;
  std::span<const Relative> alternatives;
};

constexpr Relative one(std::string_view label) { return {{{{label, 1.0}, {}}}, 1}; }

constexpr Relative two(std::string_view first, double share, std::string_view second) {
  return {{{{first, share}, {second, 1.0 - share}}}, 2};
}

// SIL: lips together and at rest, so the nearest are the sounds made with closed lips.
constexpr Relative kSil[] = {one("M"), one("B"), one("P")};
// AA: the other open unrounded vowels; AO as open but rounded; AY starts here.
constexpr Relative kAa[] = {one("AH"), one("AE"), one("AO"), one("AY")};
// AE: the next more closed front vowel, then the open ones.
constexpr Relative kAe[] = {one("EH"), one("AA"), one("AH"), one("EY")};
// AH: its unstressed twin, then a little more open, then a little more spread.
constexpr Relative kAh[] = {one("AX"), one("AA"), one("EH"), one("AE")};
// AO: OW starts with it; else an open mouth that rounds.
constexpr Relative kAo[] = {one("OW"), two("AA", 0.5, "UW"), one("AA"), one("UH")};
// AW: a glide from open to rounded.
constexpr Relative kAw[] = {two("AA", 0.55, "UW"),
                            two("AA", 0.55, "UH"),
                            two("AH", 0.55, "UW"),
                            two("AE", 0.55, "UW"),
                            two("AA", 0.55, "W"),
                            one("OW"),
                            one("AA"),
                            one("AH")};
// AX: a short half-open vowel without gesture.
constexpr Relative kAx[] = {one("AH"), one("EH"), one("IH"), one("UH")};
// AY: a glide from open to spread.
constexpr Relative kAy[] = {two("AA", 0.55, "IY"),
                            two("AA", 0.55, "IH"),
                            two("AH", 0.55, "IY"),
                            two("AE", 0.55, "IY"),
                            two("AH", 0.55, "IH"),
                            one("AE"),
                            one("AA"),
                            one("EY")};
// B: same closure; F and V at least raise the lower lip.
constexpr Relative kB[] = {one("P"), one("M"), one("V"), one("F")};
// CH: same protrusion; T then R keeps teeth and rounding in turn.
constexpr Relative kCh[] = {one("JH"), two("T", 0.4, "SH"), one("SH"),
                            one("ZH"), two("T", 0.4, "R"),  one("S")};
// D: same place, the other voicing, then nasal, fricative, lateral.
constexpr Relative kD[] = {one("T"), one("N"), one("Z"), one("L")};
// DH: same place; then alveolars, which show the tongue less.
constexpr Relative kDh[] = {one("TH"), one("D"), one("L"), one("Z"), one("T")};
// EH: neighbours in opening, both unrounded.
constexpr Relative kEh[] = {one("AE"), one("EY"), one("AX"), one("IH")};
// ER: a vowel opening with the lips of R; R alone; a weakly rounded vowel.
constexpr Relative kEr[] = {
    two("AX", 0.35, "R"), two("AH", 0.35, "R"), one("R"), one("UH"), one("AH"), one("EH")};
// EY: a glide from half open to spread.
constexpr Relative kEy[] = {two("EH", 0.5, "IY"),
                            two("EH", 0.5, "IH"),
                            two("AE", 0.5, "IY"),
                            two("AE", 0.5, "IH"),
                            one("EH"),
                            one("IH"),
                            one("IY")};
// F: same contact; TH shows the teeth over a low lip; a closure is further off.
constexpr Relative kF[] = {one("V"), one("TH"), one("P"), one("B")};
// G: velars have neutral lips; so have HH and N.
constexpr Relative kG[] = {one("K"), one("NG"), one("HH"), one("N"), one("D")};
// HH: breath through the mouth of the vowel that follows; else a neutral mouth.
constexpr Relative kHh[] = {one(kNextVowel), one("AX"), one("AH"), one("EH"), one("K"), one("G")};
// IH: the same spread, less open; then more open.
constexpr Relative kIh[] = {one("IY"), one("EH"), one("Y"), one("AX")};
// IY: the same spread; EY ends here.
constexpr Relative kIy[] = {one("IH"), one("Y"), one("EY"), one("EH")};
// JH: same protrusion; D then R keeps teeth and rounding in turn.
constexpr Relative kJh[] = {one("CH"), two("D", 0.4, "ZH"), one("ZH"),
                            one("SH"), two("D", 0.4, "R"),  one("Z")};
// K: velars have neutral lips; so have HH and N.
constexpr Relative kK[] = {one("G"), one("NG"), one("HH"), one("N"), one("T")};
// L: tongue behind the teeth, lips neutral.
constexpr Relative kL[] = {one("N"), one("D"), one("T"), one("DH")};
// M: same closure; V and F at least raise the lower lip.
constexpr Relative kM[] = {one("B"), one("P"), one("V"), one("F")};
// N: same place, lips neutral.
constexpr Relative kN[] = {one("D"), one("T"), one("L"), one("NG")};
// NG: velar with neutral lips; N is as neutral.
constexpr Relative kNg[] = {one("G"), one("K"), one("N"), one("D")};
// OW: a glide from open rounded to closed rounded.
constexpr Relative kOw[] = {two("AO", 0.5, "UW"),
                            two("AO", 0.5, "UH"),
                            two("AH", 0.4, "UW"),
                            two("AO", 0.5, "W"),
                            one("AO"),
                            one("UW"),
                            one("UH")};
// OY: a glide from rounded to spread.
constexpr Relative kOy[] = {two("AO", 0.5, "IY"),
                            two("AO", 0.5, "IH"),
                            two("OW", 0.5, "IY"),
                            two("OW", 0.5, "IH"),
                            two("AO", 0.5, "EY"),
                            two("UW", 0.5, "IY"),
                            one("AO"),
                            one("OW")};
// P: same closure; F and V at least raise the lower lip.
constexpr Relative kP[] = {one("B"), one("M"), one("F"), one("V")};
// R: the vowel of the same shape, then the rounded glide, then a weak rounding.
constexpr Relative kR[] = {one("ER"), one("W"), one("UH"), one("L")};
// S: same place and opening, then the stops, teeth nearly together.
constexpr Relative kS[] = {one("Z"), one("T"), one("D"), one("N")};
// SH: same protrusion and teeth; S then R keeps them in turn.
constexpr Relative kSh[] = {one("CH"),          one("JH"), one("ZH"),
                            two("S", 0.5, "R"), one("S"),  one("Z")};
// T: same place, the other voicing, then nasal, fricative, lateral.
constexpr Relative kT[] = {one("D"), one("N"), one("S"), one("L")};
// TH: same place; then alveolars, which show the tongue less.
constexpr Relative kTh[] = {one("DH"), one("T"), one("S"), one("L"), one("D")};
// UH: the same rounding, tighter; OW ends here.
constexpr Relative kUh[] = {one("UW"), one("OW"), one("W"), one("AX")};
// UW: the same rounding, laxer; the glide made with it.
constexpr Relative kUw[] = {one("UH"), one("W"), one("OW"), one("AO")};
// V: same contact; DH shows the teeth over a low lip; a closure is further off.
constexpr Relative kV[] = {one("F"), one("DH"), one("B"), one("P")};
// W: the vowel of the same rounding; R is the weaker one.
constexpr Relative kW[] = {one("UW"), one("UH"), one("OW"), one("R")};
// Y: the vowel of the same spread; velars are at least neutral.
constexpr Relative kY[] = {one("IY"), one("IH"), one("EY"), one("G"), one("K")};
// Z: same place and opening, then the stops, teeth nearly together.
constexpr Relative kZ[] = {one("S"), one("D"), one("T"), one("N")};
// ZH: same protrusion and teeth; Z then R keeps them in turn.
constexpr Relative kZh[] = {one("JH"),          one("SH"), one("CH"),
                            two("Z", 0.5, "R"), one("Z"),  one("S")};

constexpr RelativesRow kRows[] = {
    {"SIL", kSil}, {"AA", kAa}, {"AE", kAe}, {"AH", kAh}, {"AO", kAo}, {"AW", kAw}, {"AX", kAx},
    {"AY", kAy},   {"B", kB},   {"CH", kCh}, {"D", kD},   {"DH", kDh}, {"EH", kEh}, {"ER", kEr},
    {"EY", kEy},   {"F", kF},   {"G", kG},   {"HH", kHh}, {"IH", kIh}, {"IY", kIy}, {"JH", kJh},
    {"K", kK},     {"L", kL},   {"M", kM},   {"N", kN},   {"NG", kNg}, {"OW", kOw}, {"OY", kOy},
    {"P", kP},     {"R", kR},   {"S", kS},   {"SH", kSh}, {"T", kT},   {"TH", kTh}, {"UH", kUh},
    {"UW", kUw},   {"V", kV},   {"W", kW},   {"Y", kY},   {"Z", kZ},   {"ZH", kZh},
};

}  // namespace

std::span<const Relative> phone_relatives(std::string_view label) {
  const auto row =
      std::find_if(std::begin(kRows), std::end(kRows),
                   [&](const RelativesRow& candidate) { return candidate.label == label; });
  return row == std::end(kRows) ? std::span<const Relative>() : row->alternatives;
}

}  // namespace animeme::dam
