// Tables of other programs: their header, the fields of a row, and errors that say where.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/table_text_internal.h"
#include "fap/detail/text_scanner.h"
#include "fap/result.h"

namespace animeme::exchange {

using fap::detail::lower_case;

/// 0, 1, 2 for x, y, z in either case.
std::optional<std::size_t> axis_of(char c);
/// One to six digits, as numbers of points have.
bool is_short_number(std::string_view text);

/// The header of a table: its first line, without a byte order mark.
std::string_view first_line(std::string_view text);

/// Of comma, semicolon and tab the one that a header line has most of.
char separator_of(std::string_view header);

/// True for timecode, time_s, "Time (ms)", timestamp, elapsed, t, seconds and the like, whatever
/// case and marks: a column of times, whose unit is told from their steps.
bool is_time_name(std::string_view name);
/// True for frame, frame_number, "Frame #" and the like, whatever case and marks.
bool is_frame_name(std::string_view name);

/// "A, B, C, D, E, F and 3 more".
std::string list_of_names(const std::vector<std::string>& names);

/// The upper one of the two in the middle; `values` is not empty.
double median(std::vector<double> values);

/// The fields of a line, which is borrowed.
class Row {
 public:
  Row(const dam::TableLine& line, char separator);

  std::size_t line() const { return line_.number; }
  std::size_t size() const { return fields_.size(); }
  /// Without blanks and quotes around it.
  std::string_view text(std::size_t field) const {
    std::string_view text = dam::trimmed(fields_[field]);
    if (text.size() < 2 || !text.starts_with('"') || !text.ends_with('"')) return text;
    return dam::trimmed(text.substr(1, text.size() - 2));
  }
  std::optional<double> number(std::size_t field) const { return dam::parse_number(text(field)); }

  /// Errors: syntax, if there are more or fewer fields than `columns`.
  Result<void> check_size(std::size_t columns) const;
  /// A syntax error at a field: `message` alone, or "NAME is 'VALUE', which is ...".
  Error error(std::size_t field, const std::string& message) const;
  Error wrong(std::size_t field, const std::string& name, const std::string& which_is) const;
  /// The one for a header with a name that is there already.
  Error named_twice(std::size_t field) const;

 private:
  dam::TableLine line_;
  std::vector<std::string_view> fields_;
};

}  // namespace animeme::exchange
