#include <algorithm>

#include "tools/speech/text/chinese.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

constexpr std::size_t kLongNumber = 7;  // digits that are read one by one: telephones
// 两 instead of 二 before what is counted.
constexpr std::u32string_view kCounted = U"个個只隻次天年位本张張条條件杯块塊岁歲点點种種家间間人";

struct Number {
  std::size_t end = 0;
  std::string digits;      // ASCII with a point
  std::size_t places = 0;  // behind the point
  bool grouped = false;    // 1,234
};

Number read_number(const std::u32string& text, std::size_t at) {
  Number number;
  std::size_t i = at;
  const auto digits_from = [&](std::size_t from) {
    std::size_t count = 0;
    while (from + count < text.size() && digit_value(text[from + count]) >= 0) ++count;
    return count;
  };
  for (;;) {
    const int value = i < text.size() ? digit_value(text[i]) : -1;
    if (value >= 0) {
      number.digits += char('0' + value);
    } else if (i < text.size() && text[i] == U',' && digits_from(i + 1) == 3) {
      number.grouped = true;
    } else {
      break;
    }
    ++i;
  }
  number.places = i < text.size() && text[i] == U'.' ? digits_from(i + 1) : 0;
  if (number.places > 0) {
    number.digits += '.';
    for (std::size_t k = 1; k <= number.places; ++k) {
      number.digits += char('0' + digit_value(text[i + k]));
    }
    i += number.places + 1;
  }
  number.end = i;
  return number;
}

std::u32string one_by_one(std::string_view digits) {
  constexpr std::u32string_view kDigits = U"〇一二三四五六七八九";
  std::u32string out;
  for (const char c : digits) {
    if (c >= '0' && c <= '9') out += kDigits[std::size_t(c - '0')];
  }
  return out;
}

// The part before the point as a number, the rest digit by digit.
std::u32string spelled(const std::string& digits, bool japanese) {
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::string whole = digits.substr(0, point);
  std::u32string out =
      code_points(spell_number(whole, japanese ? "ja" : "zh", NumberForm::cardinal));
  if (out.empty()) out = one_by_one(whole);
  if (japanese) std::erase(out, U'〇');
  if (out.empty()) out = U"〇";
  if (point < digits.size()) out += U"点" + one_by_one(digits.substr(point + 1));
  return out;
}

std::u32string read_whole(const Number& number, char32_t next, bool japanese) {
  const std::string& digits = number.digits;
  const bool telephone = number.places == 0 && !number.grouped &&
                         (digits.size() >= kLongNumber || (digits.size() > 1 && digits[0] == '0'));
  const bool year = !japanese && digits.size() == 4 && number.places == 0 && next == U'年';
  if (telephone || year) return one_by_one(digits);
  if (!japanese && digits == "2" && kCounted.find(next) != std::u32string_view::npos) return U"两";
  return spelled(digits, japanese);
}

}  // namespace

SpokenText spell_han_numbers(const SpokenText& said, bool japanese) {
  const std::u32string& text = said.text;
  const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : U' '; };
  SpokenText out;
  for (std::size_t i = 0; i < text.size();) {
    if (digit_value(text[i]) < 0) {
      out.add(said, i, i + 1);
      ++i;
      continue;
    }
    Number number = read_number(text, i);
    std::size_t end = number.end;
    const Number minutes = at(end) == U':' ? read_number(text, end + 1) : Number{};
    std::u32string words;
    if (minutes.digits.size() == 2 && minutes.places == 0 && number.digits.size() <= 2) {
      end = minutes.end;
      words = spelled(number.digits, japanese) + (japanese ? U"時" : U"点");
      if (minutes.digits != "00") {
        words += spelled(minutes.digits, japanese) + U"分";
      } else if (!japanese) {
        words += U"整";
      }
    } else if (at(end) == U'%' || at(end) == U'％') {
      words = spelled(number.digits, japanese);
      words = japanese ? words + U"パーセント" : U"百分之" + words;
      ++end;
    } else {
      words = read_whole(number, at(end), japanese);
    }
    out.add(words, said.place(i, end));
    i = end;
  }
  return out;
}

}  // namespace animeme::text
