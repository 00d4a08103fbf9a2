#include "tools/speech/text/amounts_internal.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/fractions_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/units_internal.h"

namespace animeme::text {
namespace {

// Longer numbers are no amounts. What is looked at from one place has an end, since a text may be
// nothing but "1,1,1,1".
constexpr std::size_t kLongestNumber = 40, kMostPhoneDigits = 15, kLongestMultiple = 12;

bool is_english(std::string_view language) {
  return language == "en" || language.starts_with("en-");
}

bool locale_is_chinese(std::string_view language) {
  return language.starts_with("zh") || language.starts_with("cmn") || language.starts_with("yue");
}

class Amounts {
 public:
  Amounts(std::u32string_view text, const std::string& language, char32_t point,
          bool groups_by_blank, const std::string& order)
      : text_(text),
        language_(language),
        order_(order),
        point_(point),
        groups_by_blank_(groups_by_blank) {}

  char32_t at(std::size_t i) const { return i < text_.size() ? text_[i] : U' '; }
  bool digit(std::size_t i) const { return digit_value(at(i)) >= 0; }

  std::size_t digits_end(std::size_t i) const {
    while (digit(i)) ++i;
    return i;
  }
  std::size_t blanks_end(std::size_t i) const {
    while (i < text_.size() && (text_[i] == U' ' || text_[i] == 0xA0 || text_[i] == 0x202F)) ++i;
    return i;
  }
  bool free_at(std::size_t i) const {
    return (!is_letter(at(i)) || is_unparted(at(i))) && !digit(i);
  }
  std::string ascii(std::size_t first, std::size_t last) const {
    std::string out;
    for (; first < last; ++first) {
      if (digit(first)) out += char('0' + digit_value(at(first)));
    }
    return out;
  }

  // A day in numbers. The two separators have to be the same.
  Amount date(std::size_t from) const {
    std::array<std::size_t, 3> first{}, last{};
    std::size_t i = from;
    char32_t separator = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      first[k] = i;
      last[k] = i = digits_end(i);
      if (last[k] == first[k] || last[k] - first[k] > 4) return {};
      if (k == 2) break;
      const char32_t c = at(i);
      if ((c != U'/' && c != U'-' && c != U'.') || (separator != 0 && c != separator)) return {};
      separator = c;
      ++i;
    }
    if (!free_at(i) || ((at(i) == U'/' || at(i) == U'-' || at(i) == U'.') && digit(i + 1)))
      return {};
    std::array<int, 3> value{};
    for (std::size_t k = 0; k < 3; ++k) value[k] = std::atoi(ascii(first[k], last[k]).c_str());
    std::string order = order_;
    const bool year_first = last[0] - first[0] == 4, year_last = last[2] - first[2] == 4;
    // 1.2.3 is no day.
    if (!year_first && !year_last && last[2] - first[2] != 2) return {};
    if (year_first)
      order = "ymd";
    else if (separator == U'.' || (year_last && order == "ymd"))
      order = "dmy";
    std::string words = named(value, order, !year_first && !year_last, from);
    if (words.empty() && order != "ymd")
      words = named(value, order == "mdy" ? "dmy" : "mdy", !year_last, from);
    if (words.empty()) return {};
    return {i, code_points(words)};
  }

  // 12:30, 15:45:10 stay; "3:45pm" is parted.
  std::size_t time_end(std::size_t from) const {
    const std::size_t colon = digits_end(from);
    if (at(colon) != U':' || colon - from > 2) return 0;
    const std::size_t end = digits_end(colon + 1);
    return end - colon == 3 ? end : 0;
  }

  // "9:00", "9:05": a voice would say "nine zero zero".
  Amount english_clock(std::size_t from, std::size_t end) const {
    if (at(end - 2) != U'0' || at(end) == U':' || at(from) == U'0') return {};
    const std::u32string hour(text_.substr(from, end - 3 - from));
    const std::size_t word = blanks_end(end);
    const std::u32string_view half = text_.substr(word, 2);
    const bool named = word - end <= 1 && (half == U"am" || half == U"pm" || half == U"AM" ||
                                           half == U"PM" || half == U"a." || half == U"p.");
    if (!named && !free_at(end)) return {};
    const bool touches = named && word == end;
    if (at(end - 1) != U'0') return {end, hour + U" oh " + text_[end - 1] + (touches ? U" " : U"")};
    if (named) return {end, hour + (touches ? U" " : U"")};
    if (std::atoi(ascii(from, end - 3).c_str()) > 12) return {};
    return {end, hour + U" o'clock"};
  }

  // "9:30 Uhr", "9.00 Uhr": a voice would say "Uhr" twice, or the point.
  Amount german_clock(std::size_t from) const {
    const std::size_t sign = digits_end(from);
    if (sign - from > 2 || (at(sign) != U':' && at(sign) != U'.')) return {};
    const std::size_t end = digits_end(sign + 1);
    const std::size_t word = blanks_end(end);
    if (end - sign != 3 || word == end || word - end > 2) return {};
    if (text_.substr(word, 3) != U"Uhr" || !free_at(word + 3)) return {};
    const int hours = std::atoi(ascii(from, sign).c_str());
    const int minutes = std::atoi(ascii(sign + 1, end).c_str());
    if (hours > 24 || minutes > 59) return {};
    std::string words = (hours == 1 ? "ein" : std::to_string(hours)) + " Uhr";
    if (minutes > 0) words += " " + std::to_string(minutes);
    return {word + 3, code_points(words)};
  }

  // ASCII digits with a point, from a number in the manner of the language; `end` behind it. Empty
  // for what is too long.
  std::string number(std::size_t from, std::size_t& end) const {
    std::size_t i = digits_end(from);
    end = from;
    if (i - from > kLongestNumber) return {};
    std::string out = ascii(from, i);
    bool fraction = false;
    for (;;) {
      const char32_t sign = at(i);
      const bool blank = sign == 0xA0 || sign == 0x202F || (sign == U' ' && parts_by_blanks(from));
      const bool group_blank = blank && digits_end(i + 1) == i + 4;
      if ((sign != U'.' && sign != U',' && !group_blank) || !digit(i + 1) || fraction) break;
      const std::size_t next = digits_end(i + 1);
      const bool again = at(next) == sign && digit(next + 1);
      const bool group = group_blank || again || (sign != point_ && next - i == 4);
      if (!group) {
        out += '.';
        fraction = true;
      }
      if (next - from > kLongestNumber) return {};
      out += ascii(i + 1, next);
      i = next;
    }
    end = i;
    return out;
  }

  // 100 000 in languages that write so.
  bool parts_by_blanks(std::size_t from) const {
    return groups_by_blank_ && digits_end(from) - from <= 3 && at(from) != U'0';
  }

  // The longest sign of a unit; 0 if there is none.
  std::size_t unit_end(std::size_t from) const {
    for (std::size_t end = std::min(from + 4, text_.size()); end > from; --end) {
      const bool whole = !is_letter(at(end - 1)) || free_at(end);
      if (whole && !unit_of(text_.substr(from, end - from)).empty()) return end;
    }
    return 0;
  }

  // "5 million", "2,5 Mio.", "1.5M": the end of what follows, as words; 0 if there is none.
  // `money`: a currency is before or behind, so that a letter alone counts.
  Amount multiple(std::size_t from, bool money) const {
    const std::size_t first = blanks_end(from);
    if (first - from > 2) return {};
    std::size_t last = first;
    while (is_letter(at(last)) && last - first <= kLongestMultiple) ++last;
    if (digit(last)) return {};
    const std::u32string_view sign = text_.substr(first, last - first);
    const int power = multiple_of(sign);
    const std::string name = multiple_name(power, language_, {});
    // "a $5 T-shirt": a letter alone has to touch the number or the sign.
    const bool touches = first == from || !currency_of(at(last)).empty();
    if (!name.empty() && (sign.size() > 1 || (money && touches))) {
      if (at(last) == U'.' && first > from && !ends_text(text_, last + 1)) ++last;
      return {last, code_points(name.substr(0, name.size() - 1))};
    }
    const std::string word = dam::lower_case(utf8(sign));
    for (const std::string_view begin :
         {"million", "billion", "trillion", "thousand", "milliard", "mio", "mrd", "mill", "миллион",
          "миллиард", "млн", "млрд", "тыс", "bn", "万", "亿", "億"}) {
      if (first > from && word.starts_with(begin)) return {last, std::u32string(sign)};
    }
    return {};
  }

  // A number and a multiple with its currency: "1.5 million dollars".
  std::u32string many(std::u32string_view number, const std::u32string& multiple,
                      std::string_view currency) const {
    std::string plural = currency_amount("5", currency, language_);
    plural.erase(0, std::min(plural.find_first_not_of("5 \u00A0\u202F"), plural.size()));
    if (locale_is_chinese(language_) && currency == "CNY") plural = "元";
    // What joins them, by the same table that names it.
    std::string join = " ";
    for (int power = 0; power < 4; ++power) {
      const std::string alone = multiple_name(power, language_, {});
      const std::string joined = multiple_name(power, language_, plural);
      if (alone == utf8(multiple) + " ") join = joined.substr(alone.size() - 1);
    }
    return std::u32string(number) + U" " + multiple + code_points(join + plural);
  }

  Amount money(std::size_t first_digit, std::string_view currency) const {
    std::size_t end = 0;
    const std::string value = number(first_digit, end);
    if (value.empty()) return {};
    // The yen and the yuan share a sign.
    const bool chinese = locale_is_chinese(language_);
    if (chinese && currency == "JPY") currency = "CNY";
    if (const Amount more = multiple(end, true); more.end > 0) {
      return {more.end, many(text_.substr(first_digit, end - first_digit), more.words, currency)};
    }
    if (!free_at(end)) return {};
    std::string words = currency_amount(value, currency, language_);
    if (words.empty()) return {};
    // People say "yuan" and "won", CLDR the names of the money.
    if (chinese && currency == "CNY") words = value + "元";
    if (language_ == "ko" && currency == "KRW") words = value + "원";
    if (is_english(language_) && !english_money(value, currency).empty())
      words = english_money(value, currency);
    return {end, code_points(words)};
  }

  // +49 30 1234-567, (555) 123-4567, 555-123-4567.
  Amount telephone(std::size_t from) const {
    std::u32string words;
    std::size_t i = from, digits = 0, groups = 0, end = from;
    const bool plus = at(i) == U'+';
    if (plus) ++i;
    while (i < text_.size() && digits <= kMostPhoneDigits) {
      std::size_t next = i;
      while (next < text_.size() && next - i <= 2 &&
             (text_[next] == U'(' || text_[next] == U')' || text_[next] == U'-' ||
              text_[next] == U' ' || text_[next] == 0xA0 || (text_[next] == U'/' && groups == 1))) {
        ++next;
      }
      if (!digit(next) || next - i > 2) break;
      if (groups > 0) words += U", ";
      i = digits_end(next);
      if (i - next > kMostPhoneDigits) return {};
      for (std::size_t k = next; k < i; ++k) {
        words += k > next ? U" " : U"";
        words += char32_t(U'0' + digit_value(at(k)));
      }
      digits += i - next;
      ++groups;
      end = i;
    }
    const bool american = groups >= 2 && digits_end(from) - from == 3 && at(from + 3) == U'-' &&
                          (digits == 7 || digits == 10);
    const bool bracket = at(from) == U'(' && digits >= 7 && digits <= 15 && groups >= 2;
    const bool local = at(from) == U'0' && digits >= 7 && digits <= 15;
    const bool all = (plus && digits >= 7 && digits <= 15) || american || bracket || local;
    if (!all || !free_at(end)) return {};
    return {end, words};
  }

 private:
  std::string named(const std::array<int, 3>& value, const std::string& order, bool short_year,
                    std::size_t from) const {
    const auto part = [&](char name) { return value[order.find(name)]; };
    int year = part('y');
    if (short_year) year += year < 70 ? 2000 : 1900;
    if (!is_date(year, part('m'), part('d'))) return {};
    std::string words = spell_date(year, part('m'), part('d'), language_);
    // Abbreviations of "year" that nobody reads as such.
    for (const auto& [written, year_word] : {std::pair{"г.", "года"}, std::pair{"р.", "року"}}) {
      if (words.ends_with(written)) {
        words.replace(words.size() - std::string_view(written).size(), std::string::npos,
                      year_word);
      }
    }
    const std::string day = std::to_string(part('d'));
    if (language_base(language_) == "de" && words.starts_with(day + ". ")) {
      // A voice would end a sentence at the full stop.
      const auto ordinal = german_ordinal(part('d'), lower_word(text_, word_before(text_, from)));
      if (!ordinal.empty()) words.replace(0, day.size() + 1, utf8(ordinal));
    }
    if (!is_english(language_)) return words;
    const std::size_t place = words.find(day);
    const std::string ordinal = spell_number(day, language_, NumberForm::ordinal_digits);
    if (place != std::string::npos && !ordinal.empty()) words.replace(place, day.size(), ordinal);
    return words;
  }

  std::u32string_view text_;
  const std::string& language_;
  const std::string& order_;
  char32_t point_;
  bool groups_by_blank_;
};

// Digits of any script as those of ASCII, a number in words if the voice says none.
std::u32string in_words(const std::string& number, const std::string& language) {
  std::u32string out;
  for (const char32_t c : code_points(spell_number(number, language, NumberForm::cardinal))) {
    if (c != 0xAD) out += c;  // where a word may be parted
  }
  return out;
}

}  // namespace

Amount AmountReader::read(std::size_t at) {
  const char32_t begin = at < text_.size() ? text_[at] : U' ';
  const std::string_view currency = currency_of(begin);
  if (currency.empty() && begin != U'+' && begin != U'(' && digit_value(begin) < 0) return {};
  if (!known_) {
    known_ = true;
    point_ = char32_t(decimal_point(language_));
    groups_by_blank_ = groups_by_blank(language_);
    order_ = date_order(language_);
  }
  const Amounts all(text_, language_, point_, groups_by_blank_, order_);
  if (!currency.empty()) {
    const std::size_t first = all.blanks_end(at + 1);
    return all.digit(first) ? all.money(first, currency) : Amount{};
  }
  if (all.at(at) == U'+' || all.at(at) == U'(') return all.telephone(at);
  if (!all.digit(at)) return {};
  if (Amount date = all.date(at); date.end > 0) return date;
  if (language_.starts_with("de")) {
    if (Amount clock = all.german_clock(at); clock.end > 0) return clock;
  }
  if (Amount telephone = all.telephone(at); telephone.end > 0) return telephone;
  if (const std::size_t hours = all.digits_end(at); language_.starts_with("fr") &&
                                                    hours - at <= 2 && all.at(hours) == U'h' &&
                                                    all.digit(hours + 1)) {
    const std::size_t end = all.digits_end(hours + 1);
    std::u32string words(text_.substr(at, hours - at));
    words += U" heures ";
    words += text_.substr(hours + 1, end - hours - 1);
    if (end - hours == 3 && all.free_at(end)) return {end, words};
  }
  if (const std::size_t end = all.time_end(at); end > 0) {
    if (is_english(language_)) {
      if (Amount clock = all.english_clock(at, end); clock.end > 0) return clock;
    }
    const bool half = is_letter(all.at(end));
    return {half ? end : 0, half ? std::u32string(text_.substr(at, end - at)) + U" " : U""};
  }
  std::size_t end = 0;
  const std::string number = all.number(at, end);
  if (number.empty()) return {};
  const std::size_t sign = all.blanks_end(end);
  if (const std::size_t unit = all.unit_end(sign); unit > 0 && sign - end <= 1) {
    const std::string_view name = unit_of(text_.substr(sign, unit - sign));
    const std::string words = name == "USD" || name == "GBP"
                                  ? currency_amount(number, name, language_)
                                  : spell_amount(number, name, language_);
    if (!words.empty()) return {unit, code_points(words)};
  }
  // 2,5 Mio. €
  if (const Amount more = all.multiple(end, true); more.end > 0) {
    const std::size_t name = all.blanks_end(more.end);
    const std::size_t unit = name - more.end <= 1 ? all.unit_end(name) : 0;
    const std::string_view money =
        unit > 0 ? unit_of(text_.substr(name, unit - name)) : std::string_view();
    if (money.size() == 3 && is_upper(char32_t(money[0]))) {
      return {unit, all.many(text_.substr(at, end - at), more.words, money)};
    }
  }
  if (!all.free_at(end)) return {};
  if (!spell_digits_) {
    // A voice would take the parts of 100 000 for two numbers.
    constexpr std::u32string_view kBlanks = U" \u00A0\u202F";
    std::u32string whole(text_.substr(at, end - at));
    if (whole.find_first_of(kBlanks) == std::u32string::npos) return {};
    std::erase_if(whole, [&](char32_t c) { return kBlanks.find(c) != std::u32string::npos; });
    return {end, whole};
  }
  std::u32string words = in_words(number, language_);
  return {words.empty() ? 0 : end, words};
}

}  // namespace animeme::text
