#include "tools/speech/text/token_readings_internal.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/abbreviations_internal.h"
#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/fractions_internal.h"
#include "tools/speech/text/roman_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/units_internal.h"

namespace animeme::text {
namespace {

bool ascii_digit(char c) { return c >= '0' && c <= '9'; }
bool ascii_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::size_t digits_behind(std::string_view text, std::size_t at) {
  while (at < text.size() && ascii_digit(text[at])) ++at;
  return at;
}

// "1,234.50" in the manner of a language.
struct Figure {
  std::string whole, decimals;
  bool plain = true;  // no separators
  std::size_t end = 0;
};

std::optional<Figure> figure_at(std::string_view text, std::size_t at, char point) {
  Figure figure;
  std::size_t i = digits_behind(text, at);
  figure.whole = text.substr(at, i - at);
  const bool bare = figure.whole.empty();
  if (bare && !(i < text.size() && text[i] == point)) return std::nullopt;
  while (i + 1 < text.size() && ascii_digit(text[i + 1])) {
    const char sign = text[i];
    const std::size_t next = digits_behind(text, i + 1);
    const std::string_view digits = text.substr(i + 1, next - i - 1);
    const bool group = sign != point && digits.size() == 3 && !bare &&
                       (sign == '.' || sign == ',' || sign == ' ' || sign == '\'');
    if (group) {
      figure.whole += digits;
      figure.plain = false;
    } else if (sign == '.' || sign == ',') {
      if (!figure.decimals.empty()) return std::nullopt;
      figure.decimals = digits;
      i = next;
      break;
    } else {
      break;
    }
    i = next;
  }
  if (bare && figure.decimals.empty()) return std::nullopt;
  if (bare) figure.whole = "0";
  figure.end = i;
  return figure;
}

// The currency of a sign or code that is a whole token part; empty for none.
std::string_view currency_named(std::string_view sign) {
  const std::u32string wide = code_points(sign);
  const std::string_view unit = unit_of(wide);
  const bool money = unit.size() == 3 && unit[0] >= 'A' && unit[0] <= 'Z';
  return money ? unit : std::string_view();
}

class Ways {
 public:
  Ways(std::string_view token, std::string_view front, const std::string& language,
       const SpokenNumbers& numbers)
      : token_(token),
        front_(front),
        language_(language),
        numbers_(numbers),
        base_(numbers.base()),
        words_(numbers.words()),
        point_(numbers.point()) {}

  WaysToSay all() {
    abbreviation();
    numeral();
    const bool digit = std::any_of(token_.begin(), token_.end(), ascii_digit);
    const bool sign = token_.find_first_of("&+#%=@") != std::string_view::npos ||
                      std::any_of(token_.begin(), token_.end(), [](char c) { return c < 0; });
    if (digit) {
      const bool known = day() || clock() || fraction() || money() || rank() || decade() ||
                         number_with_unit() || range();
      if (!known) mixed();
    } else if (sign) {
      signs();
    }
    return {std::move(ways_), std::move(short_)};
  }

 private:
  void add(const std::string& words) {
    const std::string_view bare = dam::trimmed(words);
    if (bare.empty() || std::find(ways_.begin(), ways_.end(), bare) != ways_.end()) return;
    ways_.emplace_back(bare);
  }
  // Without the currency.
  void add_short(const std::string& words) { short_.emplace_back(dam::trimmed(words)); }
  void add_u32(const std::u32string& words) { add(utf8(words)); }
  static std::string spelled(std::string_view letters) {
    std::string out;
    for (const char32_t c : code_points(letters)) {
      if (!is_letter(c)) continue;
      if (!out.empty()) out += ' ';
      dam::append_utf8(out, c);
    }
    return out;
  }

  void abbreviation() {
    const auto meanings = meanings_of(code_points(token_), base_);
    for (const auto& meaning : meanings) add_u32(meaning);
    const bool stops = token_.find('.') != std::string_view::npos;
    if (!meanings.empty() && token_.size() <= 8) add(spelled(token_));
    if (!meanings.empty() && !stops) add(std::string(token_));
  }

  void numeral() {
    const int value = roman_value(code_points(token_));
    if (value == 0 || (token_.size() == 1 && front_ == token_)) return;
    const std::string cardinal = numbers_.cardinal(value);
    const std::string rank = numbers_.ordinal(value), hers = numbers_.ordinal(value, true);
    add(cardinal);
    if (base_ == "en") {
      add("the " + rank);
      add(rank);
    } else if (base_ == "de") {
      for (const char* article : {"der ", "die "}) add(article + rank);
      for (const char* article : {"dem ", "den ", "des ", "der "}) add(article + rank + "n");
    } else if (base_ == "nl") {
      add("de " + rank);
    } else if (!words_.base.empty()) {
      add(rank);
      add(hers);
    }
    add(spelled(token_));
  }

  // 12/05/2024, 2024-05-12, 12.5.24
  bool day() {
    std::array<int, 3> value{};
    std::array<std::size_t, 3> size{};
    std::size_t at = 0;
    char separator = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t end = digits_behind(token_, at);
      size[k] = end - at;
      if (size[k] == 0 || size[k] > 4) return false;
      value[k] = std::atoi(std::string(token_.substr(at, size[k])).c_str());
      at = end;
      if (k == 2) break;
      if (at >= token_.size() || (separator != 0 && token_[at] != separator)) return false;
      separator = token_[at++];
      if (separator != '/' && separator != '-' && separator != '.') return false;
    }
    if (at != token_.size() || (size[0] != 4 && size[2] != 4 && size[2] != 2)) return false;
    const bool first = size[0] == 4;
    int year = first ? value[0] : value[2];
    const bool short_year = !first && size[2] == 2;
    if (short_year) year += year < 70 ? 2000 : 1900;
    bool any = false;
    const bool american = !first && separator != '.' && numbers_.month_first();
    const std::pair<int, int> orders[] = {
        {first      ? value[2]
         : american ? value[1]
                    : value[0],
         first      ? value[1]
         : american ? value[0]
                    : value[1]},
        {american ? value[0] : value[1], american ? value[1] : value[0]}};
    for (const auto& [day, month] : orders) {
      if ((first && any) || !is_date(year, month, day)) continue;
      any = true;
      named_day(day, month, years_of(year));
    }
    // As figures.
    std::string figures;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_year = k == (first ? 0u : 2u);
      const std::string part =
          is_year && size[k] == 4 ? years_of(value[k]).front() : numbers_.cardinal(value[k]);
      figures += (k > 0 ? " " : "") + part;
    }
    add(figures);
    return any;
  }

  std::vector<std::string> years_of(int year) const {
    auto all = numbers_.years(year);
    if (all.empty()) all.emplace_back();
    return all;
  }

  void named_day(int day, int month, std::vector<std::string> years) {
    const std::string name = numbers_.month(month);
    if (years.size() > 3) years.resize(3);
    const std::string number = numbers_.cardinal(day), rank = numbers_.ordinal(day);
    if (base_ == "en") {
      for (const std::string& year : years) add(name + " " + rank + " " + year);
      add("the " + rank + " of " + name + " " + years.front());
      add(rank + " " + name + " " + years.front());
      add(name + " " + number + " " + years.front());
    } else if (base_ == "de") {
      const std::string rank_of_month = numbers_.ordinal(month);
      for (const char* end : {"n", "r", ""}) {
        add(rank + end + " " + name + " " + years.front());
        add(rank + end + " " + rank_of_month + end + " " + years.front());
      }
      add(rank + "n " + name + " " + years.back());
    } else if (!words_.base.empty()) {
      const std::string of =
          words_.of.empty() || base_ == "nl" ? " " : " " + std::string(words_.of) + " ";
      const std::string first = base_ == "fr" || base_ == "it" || base_ == "pt" ? rank : number;
      for (const std::string& year : years) {
        add((day == 1 ? first : number) + of + name + of + year);
        if (base_ == "es") add(number + of + name + " del " + year);
      }
    }
  }

  // 9:30, 15:45:10, 3:45 pm, 9:30 Uhr, 9.30 Uhr, 15h30
  bool clock() {
    std::size_t at = digits_behind(token_, 0);
    if (at == 0 || at > 2 || at >= token_.size()) return false;
    const char sign = token_[at];
    const std::size_t end = digits_behind(token_, at + 1);
    const std::string rest = dam::lower_case(dam::trimmed(token_.substr(end)));
    const bool uhr = rest == "uhr" || rest == "uur";
    const bool points = sign == ':' || sign == 'h' || (sign == '.' && uhr);
    if (!points || end - at != 3) return false;
    const int hour = std::atoi(std::string(token_.substr(0, at)).c_str());
    const int minute = std::atoi(std::string(token_.substr(at + 1, 2)).c_str());
    if (hour > 24 || minute > 59) return false;
    std::string half;  // of the day
    if (rest == "am" || rest == "a.m." || rest == "a.m") half = " a m";
    if (rest == "pm" || rest == "p.m." || rest == "p.m") half = " p m";
    if (!rest.empty() && half.empty() && !uhr) return false;
    hours(hour, minute, half);
    if (hour > 12 && base_ != "fr") hours(hour - 12, minute, half);
    return true;
  }

  std::string hour_name(int hour) const {
    if (hour == 1 && base_ == "de") return "ein";
    if (hour == 1 && base_ == "fr") return "une";
    if (hour == 1 && (base_ == "es" || base_ == "it")) return "una";
    if (hour == 1 && base_ == "pt") return "uma";
    if (hour == 2 && base_ == "pt") return "duas";
    return numbers_.cardinal(hour);
  }

  void hours(int hour, int minute, const std::string& half) {
    const std::string h = hour_name(hour), m = numbers_.cardinal(minute);
    const std::string next = numbers_.cardinal(hour % 12 + 1);
    const bool full = minute == 0;
    if (base_ == "en") {
      if (full) {
        add(h + (half.empty() ? " o'clock" : half));
        add(h);
        add(h + " hundred");
        return;
      }
      add(h + (minute < 10 ? " oh " : " ") + m + half);
      if (minute == 30) add("half past " + h + half);
      if (minute == 15) add("quarter past " + h + half);
      if (minute == 15) add("a quarter past " + h + half);
      if (minute == 45) add("quarter to " + next + half);
      if (minute == 45) add("a quarter to " + next + half);
      if (minute < 30 && minute % 5 == 0) add(m + " past " + h + half);
      if (minute > 30 && minute % 5 == 0)
        add(numbers_.cardinal(60 - minute) + " to " + next + half);
    } else if (base_ == "de") {
      add(h + " Uhr" + (full ? "" : " " + m));
      if (!full) add(numbers_.cardinal(hour) + " " + m);
      if (minute == 30) add("halb " + next);
      if (minute == 15) add("Viertel nach " + numbers_.cardinal(hour));
      if (minute == 15) add("viertel " + next);
      if (minute == 45) add("Viertel vor " + next);
      if (minute == 45) add("dreiviertel " + next);
    } else if (base_ == "fr") {
      const std::string word = hour < 2 ? " heure" : " heures";
      add(h + word + (full ? "" : " " + m));
      if (minute == 30) add(h + word + " et demie");
      if (minute == 15) add(h + word + " et quart");
      if (minute == 45) add(hour_name(hour % 24 + 1) + " heures moins le quart");
    } else if (base_ == "nl") {
      add(h + " uur" + (full ? "" : " " + m));
      if (!full) add(h + " " + m);
      if (minute == 30) add("half " + next);
      if (minute == 15) add("kwart over " + h);
      if (minute == 45) add("kwart voor " + next);
    } else if (base_ == "es" || base_ == "it" || base_ == "pt") {
      const std::string joint = base_ == "es" ? " y " : " e ";
      if (full) {
        add(h);
        if (base_ == "es") add(h + " en punto");
        if (base_ == "pt") add(h + " horas");
        return;
      }
      add(h + joint + m);
      add(h + " " + m);
      if (base_ == "pt") add(h + " horas e " + m);
      if (minute == 30)
        add(h + joint + (base_ == "it" ? "mezza" : base_ == "es" ? "media" : "meia"));
      if (minute == 15)
        add(h + joint + (base_ == "it" ? "un quarto" : base_ == "es" ? "cuarto" : "quinze"));
    }
  }

  // 3/4, 1 1/2, and days without a year
  bool fraction() {
    const std::size_t blank = token_.find_first_of(" -");
    const std::size_t slash = token_.find('/');
    if (slash == std::string_view::npos) return false;
    std::size_t from = 0;
    std::string whole;
    if (blank != std::string_view::npos && blank < slash) {
      whole = token_.substr(0, blank);
      from = blank + 1;
    }
    const std::string_view above = token_.substr(from, slash - from);
    const std::size_t end = digits_behind(token_, slash + 1);
    const std::string_view below = token_.substr(slash + 1, end - slash - 1);
    const auto figures = [](std::string_view text) {
      return !text.empty() && text.size() <= 4 &&
             std::all_of(text.begin(), text.end(), ascii_digit);
    };
    const std::string_view rest = token_.substr(end);
    const bool ending =
        rest.empty() || rest == "rds" || rest == "rd" || rest == "ths" || rest == "th";
    if (!figures(above) || !figures(below) || !ending || (!whole.empty() && !figures(whole))) {
      return false;
    }
    const int top = std::atoi(std::string(above).c_str());
    const int bottom = std::atoi(std::string(below).c_str());
    if (!whole.empty()) {
      add_u32(mixed_words(whole, top, bottom, language_, base_));
      const std::string joint = " " + std::string(words_.ampersand) + " ";
      for (const auto& part : fraction_words(top, bottom, language_, base_)) {
        add(numbers_.cardinal(std::atoi(whole.c_str())) + joint + utf8(part));
        add(numbers_.cardinal(std::atoi(whole.c_str())) + " " + utf8(part));
      }
      return true;
    }
    const auto parts = fraction_words(top, bottom, language_, base_);
    for (const auto& part : parts) add_u32(part);
    // The end of "drei Viertel" is easily taken for a pause.
    const bool usual = !parts.empty() && front_ == utf8(parts.front());
    const std::string a = numbers_.cardinal(top), b = numbers_.cardinal(bottom);
    for (const std::string_view word : {words_.over, words_.of}) {
      if (!word.empty()) add(a + " " + std::string(word) + " " + b);
    }
    if (base_ == "en") add(a + " out of " + b);
    if (!usual) add(a + " " + b);
    if (base_ == "en") add(a + " slash " + b);
    const bool american = numbers_.month_first();
    const int month = american ? top : bottom, day = american ? bottom : top;
    if (month >= 1 && month <= 12 && day >= 1 && day <= 31) {
      const std::string name = numbers_.month(month);
      if (base_ == "en") {
        add(name + " " + numbers_.ordinal(day));
        add("the " + numbers_.ordinal(day) + " of " + name);
      } else if (!words_.base.empty()) {
        const std::string of = base_ == "es" || base_ == "pt" ? " de " : " ";
        add(base_ == "de" ? numbers_.ordinal(day) + "r " + name
                          : numbers_.cardinal(day) + of + name);
      }
    }
    return true;
  }

  // "$5.50", "12,50 €", "5 EUR", "$1.5M"
  bool money() {
    std::size_t at = 0;
    std::string_view currency;
    if (!ascii_digit(token_[0]) && token_[0] != point_) {
      while (at < token_.size() && !ascii_digit(token_[at]) && token_[at] != ' ') ++at;
      currency = currency_named(token_.substr(0, at));
      if (currency.empty()) return false;
      while (at < token_.size() && token_[at] == ' ') ++at;
    }
    const auto figure = figure_at(token_, at, point_);
    if (!figure) return false;
    std::string_view rest = dam::trimmed(token_.substr(figure->end));
    int power = -1;
    if (!rest.empty()) {
      std::size_t end = 0;
      while (end < rest.size() && ascii_letter(rest[end])) ++end;
      power = multiple_of(code_points(rest.substr(0, end)));
      const bool behind = currency.empty() && power >= 0 && end < rest.size();
      if (!currency.empty() && power < 0) return false;
      if (power >= 0 && (behind || !currency.empty())) {
        rest.remove_prefix(end);
        if (!rest.empty() && rest[0] == '.') rest.remove_prefix(1);
        rest = dam::trimmed(rest);
      } else {
        power = -1;
      }
    }
    if (currency.empty()) currency = currency_named(rest);
    if (currency.empty()) return false;
    const std::string many = name_of(currency, "5");
    const std::string one = figure->whole == "1" ? name_of(currency, "1") : many;
    std::vector<std::string> amounts = numbers_.whole(figure->whole, Figures::grouped);
    if (!figure->decimals.empty()) amounts = numbers_.decimal(figure->whole, figure->decimals);
    if (power >= 0) {
      const std::string joined = multiple_name(power, language_, many);
      for (const std::string& amount : amounts) add(amount + " " + joined + many);
      for (const std::string& amount : amounts)
        add_short(amount + " " + multiple_name(power, language_, {}));
      return true;
    }
    if (figure->decimals.empty()) {
      for (const std::string& amount : amounts) add(amount + " " + one);
      for (const std::string& amount : numbers_.whole(figure->whole, Figures::amount))
        add(amount + " " + many);
      for (const std::string& amount : amounts) add_short(amount);
      return true;
    }
    hundredths(*figure, currency, one);
    for (const std::string& amount : amounts) add(amount + " " + many);
    for (const std::string& amount : amounts) add_short(amount);
    return true;
  }

  std::string name_of(std::string_view currency, const std::string& number) const {
    const std::string words = currency_amount(number, currency, language_);
    // Blanks of CLDR may be those that do not break.
    std::size_t at = 0;
    while (at < words.size() && (ascii_digit(words[at]) || words[at] == ' ' || words[at] < 0)) {
      const auto blank = std::string_view(words).substr(at);
      if (words[at] < 0 && !blank.starts_with("\u00A0") && !blank.starts_with("\u202F")) break;
      at += words[at] < 0 ? (blank.starts_with("\u00A0") ? 2 : 3) : 1;
    }
    return words.substr(at);
  }

  void hundredths(const Figure& figure, std::string_view currency, const std::string& name) {
    if (figure.decimals.size() != 2) return;
    const int parts = std::atoi(figure.decimals.c_str());
    const auto ways = numbers_.whole(figure.whole, Figures::grouped);
    if (ways.empty() || words_.base.empty()) return;
    const std::string& first = ways.front();
    if (parts == 0) return add(first + " " + name);
    const std::string second = numbers_.cardinal(parts);
    const std::string oh = parts < 10 && base_ == "en" ? "oh " + second : second;
    std::string cents(words_.cents);
    if (base_ == "en") {
      cents = currency == "GBP" ? (parts == 1 ? "penny" : "pence") : parts == 1 ? "cent" : "cents";
    }
    const std::string joint = " " + std::string(words_.joins) + " ";
    if (figure.whole == "0") return add(second + " " + cents);
    const bool joined = base_ == "es" || base_ == "it" || base_ == "pt";
    add(first + " " + name + joint + second + " " + cents);
    add(first + " " + name + (joined ? joint : " ") + oh);
    add(first + " " + oh);
    if (base_ == "es") add(first + joint + oh + " " + name);
    if (joined && base_ != "es") add_short(first + joint + oh);
    add(first + " " + name + " " + second + " " + cents);
    if (base_ == "en") add(first + " " + name + joint + second);
    if (base_ == "es") add(first + " " + name + " y " + second + " " + cents);
  }

  // 5th, 2., 1er, 2ª
  bool rank() {
    const std::size_t end = digits_behind(token_, 0);
    if (end == 0 || end > 6) return false;
    const std::string_view rest = token_.substr(end);
    const long long value = std::atoll(std::string(token_.substr(0, end)).c_str());
    const std::string his = numbers_.ordinal(value), hers = numbers_.ordinal(value, true);
    if (his.empty()) return false;
    if (base_ == "en" && (rest == "st" || rest == "nd" || rest == "rd" || rest == "th")) {
      add(his);
      add("the " + his);
      return true;
    }
    if (base_ == "de" && rest == ".") {
      for (const char* ending : {"n", "r", "", "s", "m"}) add(his + ending);
      add(numbers_.cardinal(value));
      return true;
    }
    constexpr std::string_view kEndings = " e er re ère ème ième nd nde º ª .º .ª ° ste de o a ";
    if (!words_.base.empty() && has_word(kEndings, rest)) {
      add(his);
      add(hers);
      return true;
    }
    return false;
  }

  // 1980s, 80s, 1980er
  bool decade() {
    const std::size_t end = digits_behind(token_, 0);
    if (end != 2 && end != 4) return false;
    const std::string_view rest = token_.substr(end);
    const int value = std::atoi(std::string(token_.substr(0, end)).c_str());
    const bool english = base_ == "en" && (rest == "s" || rest == "'s");
    const bool german = base_ == "de" && (rest == "er" || rest == "ern");
    if (value % 10 != 0 || (!english && !german)) return false;
    const auto ways =
        end == 4 ? numbers_.years(value) : numbers_.whole(token_.substr(0, end), Figures::grouped);
    for (std::string way : ways) {
      if (german) {
        add(way + std::string(rest));
        continue;
      }
      if (way.ends_with("y")) way.replace(way.size() - 1, 1, "ie");
      add(way + "s");
    }
    return true;
  }

  std::vector<std::string> figures(const Figure& figure, bool unit) const {
    return figure.decimals.empty() ? numbers_.whole(figure.whole, !figure.plain ? Figures::grouped
                                                                  : unit        ? Figures::amount
                                                                                : Figures::plain)
                                   : numbers_.decimal(figure.whole, figure.decimals);
  }

  // 1984, 1,234, 3.14, 50 %, 20 °C, -5, #5
  bool number_with_unit() {
    std::string_view text = token_;
    std::string sign;
    if (text.size() > 1 && !ascii_digit(text[0]) && text[0] != point_) {
      const std::string_view word = text[0] == '-'   ? words_.minus
                                    : text[0] == '+' ? words_.plus
                                    : text[0] == '#' ? words_.number
                                                     : std::string_view();
      if (word.empty()) return false;
      sign = std::string(word) + " ";
      text.remove_prefix(1);
    }
    const auto figure = figure_at(text, 0, point_);
    if (!figure) return false;
    const std::string_view rest = dam::trimmed(text.substr(figure->end));
    std::string unit;
    if (rest == "%") unit = words_.percent.empty() ? "" : " " + std::string(words_.percent);
    const bool named = !unit_of(code_points(rest)).empty();
    if (!rest.empty() && unit.empty() && !named) return false;
    if (named) unit = " " + unit_name(rest, figure->whole == "1" && figure->decimals.empty());
    for (const std::string& way : figures(*figure, !unit.empty())) add(sign + way + unit);
    if (text.substr(0, figure->end).find(' ') != std::string_view::npos)
      apart(text, figure->end, unit);
    if (rest == "km/h" || rest == "mph") {
      const std::string_view other = base_ == "de" && rest == "km/h"   ? "Stundenkilometer"
                                     : base_ == "fr" && rest == "km/h" ? "kilomètres heure"
                                     : base_ == "en" && rest == "km/h" ? "kilometers an hour"
                                     : base_ == "en"                   ? "miles an hour"
                                                                       : "";
      for (const std::string& way : figures(*figure, true)) {
        if (!other.empty()) add(sign + way + " " + std::string(other));
      }
    }
    if (sign.empty() && rest.empty() && base_ == "en" && figure->plain &&
        figure->decimals.empty() && figure->whole.size() <= 2) {
      const int day = std::atoi(figure->whole.c_str());
      if (day >= 1 && day <= 31) add(numbers_.ordinal(day));  // May 5
      if (day >= 1 && day <= 31) add("the " + numbers_.ordinal(day));
    }
    return true;
  }

  // The groups of 1 234 may be two numbers.
  void apart(std::string_view text, std::size_t end, const std::string& unit) {
    std::string words;
    for (std::size_t at = 0; at < end;) {
      const std::size_t last = digits_behind(text, at);
      const auto ways = numbers_.whole(text.substr(at, last - at), Figures::grouped);
      if (!ways.empty()) words += (words.empty() ? "" : " ") + ways.front();
      at = last + 1;
    }
    add(words + unit);
  }

  std::string unit_name(std::string_view sign, bool one) const {
    const std::string_view unit = unit_of(code_points(sign));
    const std::string words = spell_amount(one ? "1" : "5", unit, language_);
    const std::size_t digit = words.find(one ? '1' : '5');
    if (digit == std::string::npos) return words;
    std::string name = words.substr(0, digit) + words.substr(digit + 1);
    for (const std::string_view blank : {"\u00A0", "\u202F"}) {
      if (const std::size_t at = name.find(blank); at != std::string::npos) {
        name.replace(at, blank.size(), " ");
      }
    }
    return std::string(dam::trimmed(name));
  }

  // 1990-1995, 5-10, 3:2
  bool range() {
    const auto first = figure_at(token_, 0, point_);
    if (!first || first->end >= token_.size()) return false;
    const char sign = token_[first->end];
    if (sign != '-' && sign != ':') return false;
    const auto second = figure_at(token_, first->end + 1, point_);
    if (!second) return false;
    const std::string_view rest = dam::trimmed(token_.substr(second->end));
    std::string unit;
    if (rest == "%" && !words_.percent.empty()) unit = " " + std::string(words_.percent);
    if (!rest.empty() && unit.empty()) return false;
    const auto ways = figures(*first, !unit.empty()), more = figures(*second, !unit.empty());
    for (std::size_t i = 0; i < std::min<std::size_t>({ways.size(), more.size(), 4}); ++i) {
      if (!words_.to.empty()) add(ways[i] + " " + std::string(words_.to) + " " + more[i] + unit);
      add(ways[i] + " " + more[i] + unit);
    }
    return true;
  }

  // MP3, COVID-19, 12-year-old, +1 555 123-4567, R2-D2: what is between is left out or named.
  void mixed() {
    for (int manner = 0; manner < 5; ++manner) {
      if (manner == 3 && base_ != "en") continue;
      std::string out;
      for (std::size_t at = 0; at < token_.size();) {
        if (ascii_digit(token_[at])) {
          const std::size_t end = digits_behind(token_, at);
          const std::string_view digits = token_.substr(at, end - at);
          const auto ways = numbers_.whole(digits, Figures::plain);
          std::string words = ways.empty() ? "" : ways.front();
          if (manner == 1 || manner == 3) words = numbers_.digit_by_digit(digits, manner == 3);
          if (manner == 2 && digits.size() <= 6)
            words = numbers_.cardinal(std::atoi(std::string(digits).c_str()));
          out += " " + words + " ";
          at = end;
          continue;
        }
        std::size_t end = at;
        while (end < token_.size() && (ascii_letter(token_[end]) || token_[end] < 0 ||
                                       (token_[end] == '\'' && end > at))) {
          ++end;
        }
        if (end > at) {
          const std::string_view letters = token_.substr(at, end - at);
          const bool capitals =
              letters.size() <= 4 && std::all_of(letters.begin(), letters.end(),
                                                 [](char c) { return c >= 'A' && c <= 'Z'; });
          out += " " + (capitals && manner != 4 ? spelled(letters) : std::string(letters)) + " ";
          at = end;
          continue;
        }
        out += named_sign(token_[at], at, manner);
        ++at;
      }
      std::string tidy;
      for (const char c : out) {
        if (c != ' ' || (!tidy.empty() && tidy.back() != ' ')) tidy += c;
      }
      add(tidy);
    }
  }

  std::string named_sign(char sign, std::size_t at, int manner) const {
    const bool digit = at + 1 < token_.size() && ascii_digit(token_[at + 1]) && at > 0 &&
                       ascii_digit(token_[at - 1]);
    std::string_view word;
    if (sign == '&') word = words_.ampersand;
    if (sign == '+' && at > 0) word = words_.plus;
    if (sign == '%') word = words_.percent;
    if (sign == '#' && manner != 1) word = words_.number;
    if (sign == '.' && digit && manner != 2) word = words_.point;
    if (sign == '-' && at == 0) word = words_.minus;
    return " " + std::string(word) + " ";
  }

  // C#, R&D, and "&" alone
  void signs() {
    if (const Amount note = sharp_at(code_points(token_), 0, base_); note.end > 0) {
      add_u32(note.words);
    }
    if (token_.find('&') != std::string_view::npos || token_ == "+" || token_ == "=") mixed();
    if (token_ == "+") add(std::string(words_.plus));
    const std::u32string wide = code_points(token_);
    if (wide.size() == 1) {
      const Fraction part = fraction_sign(wide[0]);
      if (part.bottom > 0) {
        for (const auto& way : fraction_words(part.top, part.bottom, language_, base_))
          add_u32(way);
      }
    }
  }

  std::string_view token_, front_;
  const std::string& language_;
  const SpokenNumbers& numbers_;
  std::string base_;
  const NumberWords& words_;
  char point_;
  std::vector<std::string> ways_, short_;
};

}  // namespace

WaysToSay ways_to_say(std::string_view token, std::string_view front, const std::string& language,
                      const SpokenNumbers& numbers) {
  if (token.empty()) return {};
  return Ways(token, front, language, numbers).all();
}

std::string digits_in_words(std::string_view front, const SpokenNumbers& numbers, char point) {
  std::string out;
  for (std::size_t at = 0; at < front.size();) {
    if (!ascii_digit(front[at])) {
      out += front[at++];
      continue;
    }
    const auto figure = figure_at(front, at, point);
    if (!figure || figure->end <= at) return {};
    const std::string_view rest = front.substr(figure->end);
    const bool rank = rest.starts_with("st") || rest.starts_with("nd") || rest.starts_with("rd") ||
                      rest.starts_with("th");
    const auto ways =
        figure->decimals.empty()
            ? numbers.whole(figure->whole, figure->plain ? Figures::plain : Figures::grouped)
            : numbers.decimal(figure->whole, figure->decimals);
    if (ways.empty()) return {};
    at = figure->end;
    if (rank && numbers.base() == "en") {
      out += numbers.ordinal(std::atoll(figure->whole.c_str()));
      at += 2;
    } else {
      out += ways.front();
    }
  }
  // Of signs a voice knows what to say.
  const bool signs = std::string_view(out).find_first_of("%$#/+&@:") != std::string_view::npos;
  return signs ? std::string() : out;
}

}  // namespace animeme::text
