#include "tools/speech/text/fractions_internal.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

std::u32string fraction_number(int value, const std::string& language,
                               NumberForm form = NumberForm::cardinal) {
  std::u32string out;
  for (const char32_t c : code_points(spell_number(std::to_string(value), language, form))) {
    if (c != 0xAD) out += c;  // where a word may be parted
  }
  return out;
}

struct NamesOfHalves {
  std::string_view base;
  std::u32string_view one;                   // before the name of a part
  std::u32string_view half, halves;          // without "one"
  std::u32string_view third, quarter, many;  // of many: what the plural adds
  std::u32string_view join, mixed_half;      // 1 1/2: "and", "a half"
};

// An empty name: the ordinal.
constexpr NamesOfHalves kHalves[] = {
    {"en", U"one", U"half", U"halves", U"", U"quarter", U"s", U" and ", U"a half"},
    {"de", U"ein", U"halb", U"halbe", U"Drittel", U"Viertel", U"", U" ", U"einhalb"},
    {"fr", U"un", U"demi", U"demis", U"tiers", U"quart", U"s", U" et ", U"demi"},
    {"es", U"un", U"medio", U"medios", U"tercio", U"cuarto", U"s", U" y ", U"medio"},
    {"it", U"un", U"mezzo", U"mezzi", U"terzo", U"quarto", U"i", U" e ", U"mezzo"},
    {"pt", U"um", U"meio", U"meios", U"terço", U"quarto", U"s", U" e ", U"meio"},
    {"nl", U"een", U"half", U"half", U"derde", U"vierde", U"", U" en ", U"een half"},
};

const NamesOfHalves* halves_of(std::string_view base) {
  for (const NamesOfHalves& one : kHalves) {
    if (one.base == base) return &one;
  }
  return nullptr;
}

// The name of a part, for one of it.
std::u32string part_name(int bottom, const std::string& language, const NamesOfHalves& names) {
  if (bottom == 2) return std::u32string(names.half);
  if (bottom == 3 && !names.third.empty()) return std::u32string(names.third);
  if (bottom == 4) return std::u32string(names.quarter);
  if (names.base == "de") return fraction_number(bottom, language, NumberForm::ordinal) + U"l";
  if (bottom > 10 && bottom != 100 && bottom != 1000) {
    if (names.base == "es") return fraction_number(bottom, language) + U"avo";
    if (names.base == "pt") return fraction_number(bottom, language) + U" avo";
  }
  if (names.base == "es" && bottom == 100) return U"centésimo";
  return fraction_number(bottom, language, NumberForm::ordinal);
}

std::u32string plural_name(std::u32string name, int bottom, const NamesOfHalves& names) {
  if (bottom == 2) return std::u32string(names.halves);
  if (name.empty() || names.many.empty()) return name;
  if (names.base == "it") {  // terzo, terzi
    name.back() = U'i';
    return name;
  }
  if (name.back() == U's') return name;  // tiers
  return name + std::u32string(names.many);
}

bool is_usual(int bottom) {
  return (bottom >= 2 && bottom <= 10) || bottom == 12 || bottom == 15 || bottom == 16 ||
         bottom == 20 || bottom == 32 || bottom == 64 || bottom == 100 || bottom == 1000;
}

// Up to four digits; -1 if there are none or more. `end` behind them.
int small_number(std::u32string_view text, std::size_t at, std::size_t& end) {
  int value = 0;
  for (end = at; end < text.size() && end - at <= 4; ++end) {
    const int digit = digit_value(text[end]);
    if (digit < 0) break;
    value = value * 10 + digit;
  }
  return end == at || end - at > 4 ? -1 : value;
}

bool is_slash(char32_t c) { return c == U'/' || c == 0x2044 || c == 0x2215; }

// Days and pages without a name: "on 3/4", "page 1/2".
constexpr std::string_view kNoFractionBehind =
    " on since until till dated page part step slide chapter seite teil folie am vom seit le du "
    "depuis "
    "partie étape el desde página parte paso il dal pagina passo em até etapa op sinds deel stap ";

// "2/3" at `at`, where whole numbers before it are read already. Its end, or 0.
std::size_t plain_fraction(std::u32string_view text, std::size_t at, std::string_view base,
                           Fraction& value) {
  std::size_t slash = 0, end = 0;
  value.top = small_number(text, at, slash);
  if (value.top < 1 || slash >= text.size() || !is_slash(text[slash])) return 0;
  if (text[at] == U'0') return 0;
  value.bottom = small_number(text, slash + 1, end);
  if (value.bottom <= value.top || !is_usual(value.bottom)) return 0;
  if (std::gcd(value.top, value.bottom) != 1) return 0;
  // 2/3rds, 1/4th.
  if (base == "en") {
    for (const std::u32string_view ending : {U"rds", U"rd", U"ths", U"th"}) {
      if (text.substr(end, ending.size()) != ending) continue;
      end += ending.size();
      break;
    }
  }
  if (end < text.size()) {
    const char32_t next = text[end];
    const bool digit = end + 1 < text.size() && digit_value(text[end + 1]) >= 0;
    if (is_letter_or_digit(next) || is_slash(next)) return 0;
    if (digit && (next == U'.' || next == U',' || next == U':')) return 0;
  }
  return end;
}

bool may_be_fraction(std::u32string_view text, std::size_t at, std::size_t end,
                     std::string_view base) {
  const char32_t before = at > 0 ? text[at - 1] : U' ';
  if (is_slash(before) || before == U'.' || before == U',' || before == U':' || before == U'$' ||
      before == U'-') {
    return false;
  }
  const WordPlace behind = word_behind(text, end);
  const std::string next = lower_word(text, behind);
  const bool hyphen = end + 1 < text.size() && text[end] == U'-';
  const std::string after = hyphen ? lower_word(text, word_behind(text, end + 1)) : "";
  if (base == "en" && (next == "time" || after == "time")) return false;
  if (next == "of" || next == "der" || next == "des" || next == "de" || next == "van") return true;
  return !has_word(kNoFractionBehind, lower_word(text, word_before(text, at)));
}

constexpr std::string_view kGermanMonths =
    " januar februar märz april mai juni juli august september oktober november dezember jänner "
    "jan "
    "feb apr aug sept okt nov dez jahrhundert jahrhunderts ";
constexpr std::string_view kGermanE = " der die das ";
constexpr std::string_view kGermanDative =
    " in an auf mit nach von bei zu aus seit während ab vor hinter neben unter über zwischen ";
constexpr std::string_view kGermanEn =
    " am dem den des im vom zum zur beim ab seit bis einem einer eines ihrem seinem ";

// "1980s", of which a voice says "eighty z", and "100th", "one hundred th".
Amount english_rank(std::u32string_view text, std::size_t end, int value, std::size_t digits,
                    const std::string& language) {
  const std::u32string_view rest = text.substr(end);
  const auto ends = [&](std::size_t size) {
    return size >= rest.size() || !is_letter_or_digit(rest[size]);
  };
  const bool apostrophe = rest.starts_with(U"'s") || rest.starts_with(U"’s");
  const std::size_t tail = apostrophe ? 2 : rest.starts_with(U"s") ? 1 : 0;
  if (tail > 0 && ends(tail) && value % 10 == 0 && (digits == 2 || digits == 4)) {
    std::u32string words = fraction_number(value, language, NumberForm::year);
    if (words.empty()) return {};
    if (words.back() == U'y') words.replace(words.size() - 1, 1, U"ie");
    return {end + tail, words + U"s"};
  }
  const bool rank = rest.starts_with(U"st") || rest.starts_with(U"nd") || rest.starts_with(U"rd") ||
                    rest.starts_with(U"th");
  if (!rank || !ends(2) || value < 100) return {};
  const std::u32string words = fraction_number(value, language, NumberForm::ordinal);
  return {words.empty() ? 0 : end + 2, words};
}

}  // namespace

std::vector<std::u32string> fraction_words(int top, int bottom, const std::string& language,
                                           std::string_view base) {
  const NamesOfHalves* names = halves_of(base);
  if (names == nullptr || top < 1 || bottom <= top) return {};
  const std::u32string name = part_name(bottom, language, *names);
  if (name.empty()) return {};
  const auto with = [&](const std::u32string& part) {
    if (top == 1) return std::u32string(names->one) + U" " + part;
    return fraction_number(top, language) + U" " + plural_name(part, bottom, *names);
  };
  std::vector<std::u32string> all = {with(name)};
  if (base == "en" && bottom == 4) {
    all.push_back(with(fraction_number(bottom, language, NumberForm::ordinal)));
  }
  if (base == "en" && top == 1) all.push_back(U"a " + name);
  if (top == 1 && bottom == 2) all.push_back(name);
  if (base == "pt" && bottom > 10 && top == 1) all.front() = U"um " + name;
  return all;
}

std::u32string mixed_words(std::string_view whole, int top, int bottom, const std::string& language,
                           std::string_view base) {
  const NamesOfHalves* names = halves_of(base);
  const auto parts = fraction_words(top, bottom, language, base);
  std::u32string number = code_points(spell_number(whole, language, NumberForm::cardinal));
  std::erase(number, char32_t(0xAD));
  if (names == nullptr || parts.empty() || number.empty()) return {};
  if (base == "de" && whole == "1") number = U"ein";
  return number + std::u32string(names->join) +
         (bottom == 2 ? std::u32string(names->mixed_half) : parts.front());
}

Fraction fraction_sign(char32_t c) {
  switch (c) {
    case U'½':
      return {1, 2};
    case U'⅓':
      return {1, 3};
    case U'⅔':
      return {2, 3};
    case U'¼':
      return {1, 4};
    case U'¾':
      return {3, 4};
    case U'⅕':
      return {1, 5};
    case U'⅖':
      return {2, 5};
    case U'⅗':
      return {3, 5};
    case U'⅘':
      return {4, 5};
    case U'⅙':
      return {1, 6};
    case U'⅚':
      return {5, 6};
    case U'⅐':
      return {1, 7};
    case U'⅛':
      return {1, 8};
    case U'⅜':
      return {3, 8};
    case U'⅝':
      return {5, 8};
    case U'⅞':
      return {7, 8};
    case U'⅑':
      return {1, 9};
    case U'⅒':
      return {1, 10};
    default:
      return {};
  }
}

Amount fraction_at(std::u32string_view text, std::size_t at, const std::string& language,
                   std::string_view base) {
  if (halves_of(base) == nullptr) return {};
  const auto said = [](std::size_t end, const std::u32string& words) {
    return words.empty() ? Amount{} : Amount{end, words};
  };
  const auto first_of = [](const std::vector<std::u32string>& all) {
    return all.empty() ? std::u32string() : all.front();
  };
  if (const Fraction sign = fraction_sign(text[at]); sign.bottom > 0) {
    return said(at + 1, first_of(fraction_words(sign.top, sign.bottom, language, base)));
  }
  // 2½, 2 ½, 2 1/2, 2-1/2.
  std::size_t end = 0;
  const int whole = small_number(text, at, end);
  if (whole > 0 && whole < 1000 && end < text.size()) {  // no year
    const bool joins = text[end] == U'-' || is_space(text[end]);
    const std::size_t next = end + (joins ? 1 : 0);
    Fraction part = next < text.size() ? fraction_sign(text[next]) : Fraction{};
    std::size_t last = part.bottom > 0 ? next + 1 : 0;
    if (last > 0 && last < text.size() && is_letter_or_digit(text[last])) last = 0;
    if (last == 0 && joins) last = plain_fraction(text, next, base, part);
    const char32_t before = at > 0 ? text[at - 1] : U' ';
    const bool free = !is_slash(before) && before != U'.' && before != U',' && before != U':';
    if (last > 0 && free) {
      return said(last, mixed_words(std::to_string(whole), part.top, part.bottom, language, base));
    }
  }
  Fraction value;
  end = plain_fraction(text, at, base, value);
  if (end == 0 || !may_be_fraction(text, at, end, base)) return {};
  return said(end, first_of(fraction_words(value.top, value.bottom, language, base)));
}

std::u32string german_ordinal(int value, std::string_view before) {
  std::u32string words = fraction_number(value, "de", NumberForm::ordinal);
  if (words.empty()) return words;
  return words + (has_word(kGermanEn, before) ? U"n" : has_word(kGermanE, before) ? U"" : U"r");
}

Amount ordinal_at(std::u32string_view text, std::size_t at, const std::string& language,
                  std::string_view base) {
  std::size_t end = 0;
  const int value = small_number(text, at, end);
  if (value < 1 || end >= text.size()) return {};
  if (base == "de" && text[end] == U'.' && value < 1000) {
    const WordPlace next = word_behind(text, end + 1);
    if (next.empty() || next.first == end + 1) return {};
    const WordPlace before = word_before(text, at);
    const std::string behind = lower_word(text, next), article = lower_word(text, before);
    const bool month = has_word(kGermanMonths, behind);
    // "Er ist 3. Dann": a sentence ends.
    const bool inside = has_word(kGermanE, article) || has_word(kGermanEn, article);
    if (!month && (!inside || starter_follows(text, end + 1, base))) return {};
    // "in der 5. Minute"
    const bool dative = article == "der" &&
                        has_word(kGermanDative, lower_word(text, word_before(text, before.first)));
    return {end + 1, german_ordinal(value, dative ? "dem" : article)};
  }
  const auto spell = [&](bool woman, std::size_t last) -> Amount {
    if (last < text.size() && is_letter_or_digit(text[last])) return {};
    const std::u32string words = fraction_number(
        value, language, woman ? NumberForm::ordinal_feminine : NumberForm::ordinal);
    return {words.empty() ? 0 : last, words};
  };
  if (base == "en") return english_rank(text, end, value, end - at, language);
  if (base == "fr") {
    for (const std::u32string_view ending :
         {U"ième", U"ème", U"ère", U"er", U"re", U"nde", U"nd", U"e"}) {
      if (text.substr(end, ending.size()) != ending) continue;
      const bool woman = value == 1 && (ending == U"re" || ending == U"ère");
      return spell(woman, end + ending.size());
    }
  }
  if (base == "es" || base == "it" || base == "pt") {
    const std::size_t sign = end + (text[end] == U'.' ? 1 : 0);
    if (sign < text.size() && (text[sign] == U'º' || text[sign] == U'ª')) {
      return spell(text[sign] == U'ª', sign + 1);
    }
  }
  if (base == "nl") {
    for (const std::u32string_view ending : {U"ste", U"de", U"e"}) {
      if (text.substr(end, ending.size()) == ending) return spell(false, end + ending.size());
    }
  }
  return {};
}

}  // namespace animeme::text
