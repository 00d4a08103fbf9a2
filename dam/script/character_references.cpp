// Character references of HTML, as captions have them.
#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <utility>

#include "dam/script/script_cues_internal.h"
#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

// From U+00A0 on.
constexpr std::array<std::string_view, 96> kLatin = {
    "nbsp",   "iexcl",  "cent",   "pound",  "curren", "yen",    "brvbar", "sect",   "uml",
    "copy",   "ordf",   "laquo",  "not",    "shy",    "reg",    "macr",   "deg",    "plusmn",
    "sup2",   "sup3",   "acute",  "micro",  "para",   "middot", "cedil",  "sup1",   "ordm",
    "raquo",  "frac14", "frac12", "frac34", "iquest", "Agrave", "Aacute", "Acirc",  "Atilde",
    "Auml",   "Aring",  "AElig",  "Ccedil", "Egrave", "Eacute", "Ecirc",  "Euml",   "Igrave",
    "Iacute", "Icirc",  "Iuml",   "ETH",    "Ntilde", "Ograve", "Oacute", "Ocirc",  "Otilde",
    "Ouml",   "times",  "Oslash", "Ugrave", "Uacute", "Ucirc",  "Uuml",   "Yacute", "THORN",
    "szlig",  "agrave", "aacute", "acirc",  "atilde", "auml",   "aring",  "aelig",  "ccedil",
    "egrave", "eacute", "ecirc",  "euml",   "igrave", "iacute", "icirc",  "iuml",   "eth",
    "ntilde", "ograve", "oacute", "ocirc",  "otilde", "ouml",   "divide", "oslash", "ugrave",
    "uacute", "ucirc",  "uuml",   "yacute", "thorn",  "yuml"};

constexpr std::pair<std::string_view, char32_t> kReferences[] = {
    {"amp", U'&'},     {"lt", U'<'},       {"gt", U'>'},       {"quot", U'"'},
    {"apos", U'\''},   {"lrm", U' '},      {"rlm", U' '},      {"ensp", U' '},
    {"emsp", U' '},    {"thinsp", U' '},   {"zwnj", 0x200C},   {"zwj", 0x200D},
    {"ndash", 0x2013}, {"mdash", 0x2014},  {"lsquo", 0x2018},  {"rsquo", 0x2019},
    {"sbquo", 0x201A}, {"ldquo", 0x201C},  {"rdquo", 0x201D},  {"bdquo", 0x201E},
    {"bull", 0x2022},  {"hellip", 0x2026}, {"lsaquo", 0x2039}, {"rsaquo", 0x203A},
    {"euro", 0x20AC},  {"trade", 0x2122},  {"OElig", 0x152},   {"oelig", 0x153},
    {"Scaron", 0x160}, {"scaron", 0x161},  {"Yuml", 0x178},    {"Zcaron", 0x17D},
    {"zcaron", 0x17E}, {"ccaron", 0x10D},  {"Ccaron", 0x10C},  {"lsqb", U'['},
    {"rsqb", U']'},    {"lpar", U'('},     {"rpar", U')'},     {"num", U'#'},
    {"percnt", U'%'},  {"dollar", U'$'},   {"comma", U','},    {"period", U'.'},
    {"excl", U'!'},    {"quest", U'?'},    {"colon", U':'},    {"semi", U';'},
    {"sol", U'/'},     {"lowbar", U'_'},   {"hyphen", U'-'},   {"NewLine", U' '},
    {"Tab", U' '},     {"sung", 0x266A}};

char32_t number_of(std::string_view digits) {
  const bool hex = digits.starts_with('x') || digits.starts_with('X');
  if (hex) digits.remove_prefix(1);
  std::uint32_t code = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), code, hex ? 16 : 10);
  if (error != std::errc() || end != digits.data() + digits.size()) return 0;
  if (code >= 0x80 && code < 0xA0) return from_windows(char(code));  // as browsers do
  if (code < 0x20 || code == 0x7F) return U' ';
  return code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF) ? 0xFFFD : char32_t(code);
}

// The character; 0: there is none of the name.
char32_t character_of(std::string_view name) {
  if (name.starts_with('#')) return number_of(name.substr(1));
  for (const auto& [known, code] : kReferences) {
    if (known == name) return code;
  }
  const auto latin = std::find(kLatin.begin(), kLatin.end(), name);
  if (latin == kLatin.end() || name.empty()) return 0;
  const auto code = char32_t(0xA0 + (latin - kLatin.begin()));
  return code == 0xA0 || code == 0xAD ? U' ' : code;
}

}  // namespace

std::string without_references(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    if (text[0] == '&') {
      constexpr std::size_t kLongestName = 10;
      const std::size_t end = text.substr(0, kLongestName + 1).find(';');
      const char32_t code =
          end <= kLongestName ? character_of(text.substr(1, end - 1)) : char32_t(0);
      if (code != 0) {
        append_utf8(out, code);
        text.remove_prefix(end + 1);
        continue;
      }
    }
    out += text[0];
    text.remove_prefix(1);
  }
  return out;
}

}  // namespace animeme::dam
