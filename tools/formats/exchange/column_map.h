/// @file
/// Tables whose columns have names of their own: what each of them is.
///
///     auto rule = animeme::exchange::parse_column_rule("jaw=jawOpen*0.01");
///     auto table = animeme::exchange::rename_columns(text, {*rule});
///
/// A meaning is a name that the readers of this folder know: a time (time_s, timecode), frame,
/// face_id, confidence, success, a shape of ARKit (jawOpen), a coordinate of a landmark (x_61,
/// 8.3_y), or a FAP (fap3, open_jaw, fap3_open_jaw).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::exchange {

/// One column of a table and what it is.
struct ColumnRule {
  /// Its name as it stands in the header, case and blanks around it aside. A "*" in it stands for
  /// any text, and for that text in `meaning`: "mouthL.*" is "8.3_*". In a table with one row a
  /// point, likewise the name of a point: "mouthL" is "8.3".
  std::string name;
  std::string meaning;  ///< see above; "-": the column is left out
  double factor = 1;    ///< values are multiplied by it; finite, not 0
};

/// Rules; of several that fit a column, the first one counts.
using ColumnMap = std::vector<ColumnRule>;

/// "NAME=MEANING" or "NAME=MEANING*FACTOR". Errors: syntax (neither), invalid_argument (a meaning
/// that nothing here knows; a factor that is 0 or no number).
Result<ColumnRule> parse_column_rule(std::string_view text);

/// A table "column,meaning" or "column,meaning,factor", a rule a line, fields between commas,
/// semicolons or tabs; lines that begin with # are left out, as is a first line that says "column".
/// Errors, with the line: those of parse_column_rule(); truncated (no rule).
Result<ColumnMap> read_column_map(std::string_view text);

/// A table with its columns renamed, multiplied and left out. Lines keep their numbers, fields of
/// columns that no rule names stay as they are. Errors: not_found (a rule that no column fits; the
/// message lists the columns), syntax (a value to be multiplied that is no number: line and
/// column).
Result<std::string> rename_columns(std::string_view table, const ColumnMap& map);

}  // namespace animeme::exchange
