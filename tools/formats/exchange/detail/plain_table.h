// Tables as spreadsheets, R and numpy write them, in the form that the readers here want. Internal.
#pragma once

#include <string>
#include <string_view>

namespace animeme::exchange {

/// The same table with LF at the ends of lines, without quotes, comments and a "sep=;" before the
/// header, rows of nothing but separators, or separators behind the last field that the header does
/// not have. Fields between bars or blanks are between tabs then; the header may follow a "#", as
/// numpy writes it. A separator within quotes becomes a blank, or a point between digits. Lines
/// keep their numbers. What is no table comes back as it is.
std::string plain_table(std::string_view text);

/// True for what programs write where they have no number: nothing, NaN, NA, null, None, "-".
bool is_missing(std::string_view field);

}  // namespace animeme::exchange
