// Reading tables with a header line: lines, fields, columns. Internal.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "dam/script/script_text_internal.h"

namespace animeme::dam {

/// One line that is not empty, with its number from 1.
struct TableLine {
  std::size_t number = 0;
  std::string_view text;
};

/// The lines of a text without their ends (LF or CR LF), a leading byte order mark dropped.
std::vector<TableLine> table_lines(std::string_view text);

std::vector<std::string_view> split_fields(std::string_view line, char separator);

/// A whole field as a number, "." as decimal point whatever the locale; nothing otherwise. May be
/// infinite or NaN if it says so.
std::optional<double> parse_number(std::string_view field);

/// Index of a column by name.
std::optional<std::size_t> find_column(const std::vector<std::string_view>& header,
                                       std::string_view name);

}  // namespace animeme::dam
