#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/units_internal.h"

namespace animeme::text {
namespace {

struct MoneyName {
  std::string_view base, currency, one, many;
};
constexpr MoneyName kMoneyNames[] = {
    {"de", "USD", "Dollar", "Dollar"},   {"de", "GBP", "Pfund", "Pfund"},
    {"fr", "USD", "dollar", "dollars"},  {"fr", "GBP", "livre", "livres"},
    {"es", "USD", "dólar", "dólares"},   {"es", "GBP", "libra", "libras"},
    {"it", "USD", "dollaro", "dollari"}, {"it", "GBP", "sterlina", "sterline"},
    {"pt", "USD", "dólar", "dólares"},   {"pt", "GBP", "libra", "libras"},
    {"nl", "USD", "dollar", "dollar"},   {"nl", "GBP", "pond", "pond"},
    {"en", "USD", "dollar", "dollars"},  {"en", "GBP", "pound", "pounds"},
};

struct Multiples {
  std::string_view base, names[4], join;
};
constexpr Multiples kMultiples[] = {
    {"en", {"thousand", "million", "billion", "trillion"}, " "},
    {"de", {"Tausend", "Millionen", "Milliarden", "Billionen"}, " "},
    {"fr", {"mille", "millions", "milliards", "billions"}, " de "},
    {"es", {"mil", "millones", "mil millones", "billones"}, " de "},
    {"it", {"mila", "milioni", "miliardi", "bilioni"}, " di "},
    {"pt", {"mil", "milhões", "mil milhões", "biliões"}, " de "},
    {"nl", {"duizend", "miljoen", "miljard", "biljoen"}, " "},
};

struct MultipleSign {
  std::string_view sign;
  int power;
};
constexpr MultipleSign kMultipleSigns[] = {
    {"k", 0},    {"tsd", 0}, {"m", 1},   {"mn", 1},  {"mln", 1}, {"mio", 1},
    {"mill", 1}, {"b", 2},   {"bn", 2},  {"bln", 2}, {"mrd", 2}, {"mld", 2},
    {"md", 2},   {"mds", 2}, {"mdr", 2}, {"t", 3},   {"tn", 3},  {"trn", 3},
};

}  // namespace

std::string currency_amount(const std::string& number, std::string_view currency,
                            const std::string& language) {
  const std::string base = language_base(language);
  for (const MoneyName& row : kMoneyNames) {
    if (row.base != base || row.currency != currency) continue;
    std::string written = number;
    if (const std::size_t at = written.find('.'); at != std::string::npos) {
      written.replace(at, 1, 1, decimal_point(language));
    }
    return written + " " + std::string(number == "1" ? row.one : row.many);
  }
  return spell_amount(number, currency, language);
}

std::string multiple_name(int power, std::string_view language, std::string_view currency_name) {
  if (power < 0 || power > 3) return {};
  const std::string base = language_base(language);
  for (const Multiples& row : kMultiples) {
    if (row.base != base) continue;
    std::string name(row.names[power]);
    if (base == "pt" && dam::lower_case(language) == "pt-br" && power > 1) {
      name = power == 2 ? "bilhões" : "trilhões";
    }
    // "mil euros", but "millions d'euros".
    const bool vowel = !currency_name.empty() &&
                       std::string_view("aeiouAEIOU").find(currency_name[0]) != std::string::npos;
    if (power == 0 || currency_name.empty()) return name + " ";
    if (base == "fr" && vowel) return name + " d'";
    return name + std::string(row.join);
  }
  return {};
}

int multiple_of(std::u32string_view sign) {
  const std::string lower = dam::lower_case(utf8(sign));
  for (const MultipleSign& row : kMultipleSigns) {
    if (row.sign == lower) return row.power;
  }
  return -1;
}

}  // namespace animeme::text
