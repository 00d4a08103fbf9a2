#include "tools/speech/text/units_internal.h"

#include <algorithm>
#include <cstdlib>

#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

struct Unit {
  std::u32string_view sign;
  std::string_view name;
};

// Signs that people write behind numbers, and what CLDR calls the unit.
constexpr Unit kUnits[] = {
    {U"°C", "celsius"},
    {U"℃", "celsius"},
    {U"°F", "fahrenheit"},
    {U"℉", "fahrenheit"},
    {U"°", "degree"},
    {U"km/h", "kilometer-per-hour"},
    {U"km", "kilometer"},
    {U"m", "meter"},
    {U"cm", "centimeter"},
    {U"mm", "millimeter"},
    {U"km²", "square-kilometer"},
    {U"m²", "square-meter"},
    {U"m/s", "meter-per-second"},
    {U"kg", "kilogram"},
    {U"g", "gram"},
    {U"mg", "milligram"},
    {U"t", "tonne"},
    {U"l", "liter"},
    {U"L", "liter"},
    {U"ml", "milliliter"},
    {U"GB", "gigabyte"},
    {U"MB", "megabyte"},
    {U"kB", "kilobyte"},
    {U"TB", "terabyte"},
    {U"kW", "kilowatt"},
    {U"W", "watt"},
    {U"kWh", "kilowatt-hour"},
    {U"V", "volt"},
    {U"Hz", "hertz"},
    {U"kHz", "kilohertz"},
    {U"MHz", "megahertz"},
    {U"GHz", "gigahertz"},
    {U"ms", "millisecond"},
    {U"mph", "mile-per-hour"},
    {U"€", "EUR"},
    {U"$", "USD"},
    {U"£", "GBP"},
    {U"¥", "JPY"},
    {U"￥", "JPY"},
    {U"₽", "RUB"},
    {U"₹", "INR"},
    {U"₩", "KRW"},
    {U"₺", "TRY"},
    {U"₴", "UAH"},
    {U"₪", "ILS"},
    {U"EUR", "EUR"},
    {U"USD", "USD"},
    {U"GBP", "GBP"},
    {U"JPY", "JPY"},
    {U"CHF", "CHF"},
    {U"CNY", "CNY"},
    {U"RMB", "CNY"},
    {U"INR", "INR"},
    {U"RUB", "RUB"},
    {U"zł", "PLN"},
    {U"Kč", "CZK"},
    {U"км/ч", "kilometer-per-hour"},
    {U"км", "kilometer"},
    {U"кг", "kilogram"},
    {U"см", "centimeter"},
    {U"мм", "millimeter"},
    {U"руб", "RUB"},
    {U"грн", "UAH"},
};

}  // namespace

std::string_view unit_of(std::u32string_view sign) {
  for (const Unit& unit : kUnits) {
    if (unit.sign == sign) return unit.name;
  }
  return {};
}

std::string_view currency_of(char32_t sign) {
  const bool before =
      std::u32string_view(U"$€£¥￥₽₹₩₺₴₪").find(sign) != std::u32string_view::npos;
  return before ? unit_of({&sign, 1}) : std::string_view();
}

bool is_unparted(char32_t c) {
  if (c < 0x0E00 || !is_letter(c)) return false;
  const std::string script = script_of(c);
  constexpr std::string_view kUnparted[] = {"Hani", "Hira", "Kana", "Hang", "Bopo",
                                            "Thai", "Laoo", "Khmr", "Mymr"};
  return std::find(std::begin(kUnparted), std::end(kUnparted), script) != std::end(kUnparted);
}

std::string english_money(const std::string& value, std::string_view currency) {
  const std::size_t point = value.find('.');
  const bool known = currency == "USD" || currency == "EUR" || currency == "GBP";
  if (!known || point == std::string::npos || value.size() != point + 3) return {};
  const int parts = std::atoi(value.c_str() + point + 1);
  const std::string whole = value.substr(0, point);
  std::string words = whole + (currency == "EUR"   ? " euro"
                               : currency == "GBP" ? " pound"
                                                   : " dollar");
  if (whole != "1") words += "s";
  if (parts == 0) return words;
  const std::string small =
      currency == "GBP" ? (parts == 1 ? " penny" : " pence") : (parts == 1 ? " cent" : " cents");
  return (whole == "0" ? "" : words + " and ") + std::to_string(parts) + small;
}

}  // namespace animeme::text
