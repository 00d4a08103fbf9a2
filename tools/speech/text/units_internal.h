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

}  // namespace animeme::text
