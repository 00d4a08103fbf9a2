// Signs of units and currencies. Inside of written.cpp.
#pragma once

#include <string>
#include <string_view>

namespace animeme::text {

/// The name of a unit or currency for spell_amount(), empty for anything else.
std::string_view unit_of(std::u32string_view sign);

/// The same for signs that stand before their number: $ € £ ¥.
std::string_view currency_of(char32_t sign);

/// A letter of a script that is written without blanks (or, Korean, with endings behind numbers):
/// numbers touch it.
bool is_unparted(char32_t c);

/// "5 dollars and 20 cents", which CLDR has no names for; empty for others.
std::string english_money(const std::string& value, std::string_view currency);

/// "5 Dollar", "1 livre", "5 dollars": what people call the money of a country whose name CLDR
/// adds. `number` is ASCII with a point. Else by CLDR; empty without its data.
std::string currency_amount(const std::string& number, std::string_view currency,
                            const std::string& language);

/// Thousands (0), millions, thousands of millions, millions of millions (3) behind a number, as the
/// language names them, with what joins them to a currency: "millions d'". Empty if unknown here.
std::string multiple_name(int power, std::string_view language, std::string_view currency_name);

/// The power that a sign or abbreviation between a number and a currency means: "M", "bn", "Mio";
/// -1 for none.
int multiple_of(std::u32string_view sign);

}  // namespace animeme::text
