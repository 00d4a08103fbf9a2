#include "tools/speech/text/spoken_numbers_internal.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

constexpr std::size_t kMostDigitsOfCardinal = 15;

constexpr NumberWords kNumberWords[] = {
    {"en", "point", "and", "cents", "to", "over", "of", "percent", "and", "plus", "minus",
     "number"},
    {"de", "Komma", "und", "Cent", "bis", "durch", "von", "Prozent", "und", "plus", "minus",
     "Nummer"},
    {"fr", "virgule", "et", "centimes", "à", "sur", "", "pour cent", "et", "plus", "moins",
     "numéro"},
    {"es", "coma", "con", "céntimos", "a", "sobre", "de", "por ciento", "y", "más", "menos",
     "número"},
    {"it", "virgola", "e", "centesimi", "a", "su", "", "per cento", "e", "più", "meno", "numero"},
    {"pt", "vírgula", "e", "cêntimos", "a", "sobre", "de", "por cento", "e", "mais", "menos",
     "número"},
    {"nl", "komma", "en", "cent", "tot", "gedeeld door", "van", "procent", "en", "plus", "min",
     "nummer"},
    {},
};

std::string unparted(const std::string& words) {
  std::u32string out;
  for (const char32_t c : code_points(words)) {
    if (c != 0xAD) out += c;
  }
  return utf8(out);
}

void add_new(std::vector<std::string>& all, std::string words) {
  if (words.empty() || std::find(all.begin(), all.end(), words) != all.end()) return;
  all.push_back(std::move(words));
}

}  // namespace

const NumberWords& number_words(std::string_view base) {
  const auto found = std::find_if(std::begin(kNumberWords), std::end(kNumberWords) - 1,
                                  [&](const NumberWords& row) { return row.base == base; });
  return *found;
}

SpokenNumbers::SpokenNumbers(const std::string& language)
    : language_(language),
      base_(language_base(language)),
      words_(&number_words(base_)),
      point_(decimal_point(language)),
      month_first_(date_order(language) == "mdy") {}

std::string SpokenNumbers::cardinal(long long value) const {
  return unparted(spell_number(std::to_string(value), language_, NumberForm::cardinal));
}

std::string SpokenNumbers::ordinal(long long value, bool feminine) const {
  return unparted(spell_number(std::to_string(value), language_,
                               feminine ? NumberForm::ordinal_feminine : NumberForm::ordinal));
}

std::string SpokenNumbers::digit_by_digit(std::string_view digits, bool oh) const {
  std::string out;
  for (const char c : digits) {
    if (c < '0' || c > '9') continue;
    const std::string word = oh && c == '0' ? "oh" : cardinal(c - '0');
    if (word.empty()) return {};
    out += (out.empty() ? "" : " ") + word;
  }
  return out;
}

std::vector<std::string> SpokenNumbers::years(int year) const {
  std::vector<std::string> all;
  const int century = year / 100, rest = year % 100;
  const bool pairs = year >= 1100 && year <= 2099;
  const std::string number = std::to_string(year);
  const std::string with_and = unparted(spell_number(number, language_, NumberForm::cardinal_and));
  if (base_ == "en" && pairs) {
    const std::string first = cardinal(century);
    const bool thousand = century % 10 == 0;  // two thousand
    if (thousand && rest < 10) add_new(all, cardinal(year));
    if (thousand && rest < 10) add_new(all, with_and);
    if (rest == 0 && !thousand) add_new(all, first + " hundred");
    if (rest > 0 && rest < 10) add_new(all, first + " oh " + cardinal(rest));
    if (rest >= 10) add_new(all, first + " " + cardinal(rest));
    if (rest > 0 && !thousand) add_new(all, first + " hundred and " + cardinal(rest));
    if (thousand) add_new(all, cardinal(year));
    if (thousand) add_new(all, with_and);
  } else if (pairs && century < 20) {
    const std::string first = cardinal(century), second = rest > 0 ? cardinal(rest) : "";
    if (base_ == "de") add_new(all, first + "hundert" + second);
    if (base_ == "fr") add_new(all, cardinal(year));  // before the other way
    if (base_ == "nl") {
      add_new(all, first + "honderd" + (rest > 0 ? " " + second : ""));
      if (rest > 9) add_new(all, first + " " + second);
    }
  }
  add_new(all, unparted(spell_number(number, language_, NumberForm::year)));
  add_new(all, cardinal(year));
  return all;
}

std::vector<std::string> SpokenNumbers::whole(std::string_view digits, Figures figures) const {
  const bool plain = figures == Figures::plain, pairs = figures != Figures::grouped;
  std::vector<std::string> all;
  if (digits.empty()) return all;
  const bool zero = digits.size() > 1 && digits[0] == '0';
  if (digits.size() > kMostDigitsOfCardinal) {
    add_new(all, digit_by_digit(digits));
    if (base_ == "en") add_new(all, digit_by_digit(digits, true));
    return all;
  }
  const long long value = std::atoll(std::string(digits).c_str());
  const auto size = digits.size();
  if (plain && size == 4 && value >= 1100 && value <= 2099) {
    for (std::string& year : years(int(value))) add_new(all, std::move(year));
  }
  if (zero) add_new(all, digit_by_digit(digits));
  if (zero && base_ == "en") add_new(all, digit_by_digit(digits, true));
  add_new(all, cardinal(value));
  // "hundert" for "einhundert", "tausend" for "eintausend".
  if (base_ == "de") {
    const std::string number = cardinal(value);
    if (number.starts_with("einhundert") || number.starts_with("eintausend")) {
      add_new(all, number.substr(3));
    }
  }
  if (base_ == "en") {
    const std::string with_and =
        unparted(spell_number(std::string(digits), language_, NumberForm::cardinal_and));
    if (value < 1000000) add_new(all, with_and);
    for (const std::string& one : {all.back(), cardinal(value)}) {
      if (one.starts_with("one hundred") || one.starts_with("one thousand")) {
        add_new(all, "a" + one.substr(3));
      }
    }
    const int high = int(value / 100), low = int(value % 100);
    if (pairs && !zero && size == 4 && high % 10 != 0) {
      add_new(all, cardinal(high) + (low == 0   ? " hundred"
                                     : low < 10 ? " oh " + cardinal(low)
                                                : " " + cardinal(low)));
    }
    if (pairs && size == 3 && low > 0 && !zero) {
      add_new(all, cardinal(high) + (low < 10 ? " oh " : " ") + cardinal(low));
    }
  }
  if (plain && size > 2) add_new(all, digit_by_digit(digits));
  if (plain && size > 2 && base_ == "en") add_new(all, digit_by_digit(digits, true));
  // Telephone numbers of France and others come in pairs.
  if (plain && size == 4 && !zero && base_ != "en") {
    add_new(all, cardinal(value / 100) + " " + cardinal(value % 100));
  }
  return all;
}

std::vector<std::string> SpokenNumbers::decimal(std::string_view whole_part,
                                                std::string_view decimals) const {
  std::vector<std::string> all;
  if (words_->point.empty() || whole_part.size() > kMostDigitsOfCardinal ||
      decimals.size() > kMostDigitsOfCardinal) {
    return all;
  }
  const std::string point = " " + std::string(words_->point) + " ";
  const std::string first = cardinal(std::atoll(std::string(whole_part).c_str()));
  const std::string digits = digit_by_digit(decimals);
  std::string number = cardinal(std::atoll(std::string(decimals).c_str()));
  if (decimals.starts_with('0') && decimals.size() > 1) {
    number = cardinal(0) + " " + number;
  }
  // Romance languages say the decimals as a number.
  const bool together = base_ == "fr" || base_ == "es" || base_ == "it" || base_ == "pt";
  add_new(all, first + point + (together ? number : digits));
  add_new(all, first + point + (together ? digits : number));
  if (decimals == "5" && whole_part != "0") {
    if (base_ == "de") add_new(all, (whole_part == "1" ? "ein" : first) + "einhalb");
    if (base_ == "en") add_new(all, first + " and a half");
    if (base_ == "fr") add_new(all, first + " et demi");
    if (base_ == "es") add_new(all, first + " y medio");
    if (base_ == "nl") add_new(all, first + " en een half");
  }
  if (base_ == "en" && whole_part == "0") add_new(all, "point " + digits);
  if (base_ == "en") add_new(all, first + point + digit_by_digit(decimals, true));
  return all;
}

std::string SpokenNumbers::month(int month) const {
  // The longest word of a date that is no digit: "4 de marzo de 2001".
  const std::string date = spell_date(2001, month, 4, language_);
  std::string best;
  for (std::size_t at = 0; at < date.size();) {
    std::size_t end = date.find_first_of(" ,.", at);
    if (end == std::string::npos) end = date.size();
    const std::string word = date.substr(at, end - at);
    const bool digit =
        std::any_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!digit && word.size() > best.size()) best = word;
    at = end + 1;
  }
  return best;
}

}  // namespace animeme::text
