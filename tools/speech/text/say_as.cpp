#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/say_as_internal.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

std::string digits_of(const Said& said) {
  std::string digits;
  for (const char32_t c : said.text) {
    if (digit_value(c) >= 0) digits += char('0' + digit_value(c));
  }
  return digits;
}

}  // namespace

Said say_apart(const Said& said) {
  Said out;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (!is_letter_or_digit(said.text[i])) continue;
    if (out.size() > 0) out.add(U" ", said.places[i]);
    out.add(said, i, i + 1);
  }
  return out;
}

Said say_telephone(const Said& said) {
  Said out;
  bool gap = false;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (digit_value(said.text[i]) < 0) {
      gap = true;
      continue;
    }
    if (out.size() > 0) out.add(gap ? U", " : U" ", said.places[i]);
    out.add(said, i, i + 1);
    gap = false;
  }
  return out;
}

Said say_instead(const Said& said, const std::string& words) {
  if (words.empty() || said.size() == 0) return said;
  Said out;
  out.add(code_points(words), said.place(0, said.size()));
  return out;
}

Said say_ordinal(const Said& said, const std::string& language) {
  return say_instead(said, spell_number(digits_of(said), language, NumberForm::ordinal_digits));
}

Said say_date(const Said& said, const std::string& format, const std::string& language) {
  std::vector<int> values;
  bool inside = false;
  for (const char32_t c : said.text) {
    const int digit = digit_value(c);
    if (digit >= 0 && !inside) values.push_back(0);
    if (digit >= 0 && values.back() < 100000) values.back() = values.back() * 10 + digit;
    inside = digit >= 0;
  }
  std::string order = format;
  std::erase_if(order, [](char c) { return c != 'd' && c != 'm' && c != 'y'; });
  order.erase(std::unique(order.begin(), order.end()), order.end());
  if (order.size() != 3 || values.size() != 3) return said;
  const auto part = [&](char name) { return values[std::min(order.find(name), std::size_t(2))]; };
  int year = part('y');
  if (year < 100) year += year < 70 ? 2000 : 1900;
  if (!is_date(year, part('m'), part('d'))) return said;
  return say_instead(said, spell_date(year, part('m'), part('d'), language));
}

}  // namespace animeme::text
