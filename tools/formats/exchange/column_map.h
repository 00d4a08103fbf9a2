/// @file
/// Maps custom column names of tables to known meanings.
///
///     auto rule = animeme::exchange::parse_column_rule("jaw=jawOpen*0.01");
///     auto table = animeme::exchange::rename_columns(text, {*rule});
///
/// A meaning is a name that the readers of this folder recognise: a time (time_s, timecode), frame,
/// face_id, confidence, success, a shape of ARKit (jawOpen), a coordinate of a landmark (x_61,
/// 8.3_y), or a FAP (fap3, open_jaw, fap3_open_jaw).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::exchange {

/// A column of a table and its meaning.
struct ColumnRule {
  /// Its name in the header, ignoring case and surrounding blanks. A "*" matches any text, which
  /// replaces the "*" in `meaning`: "mouthL.*" is "8.3_*". In a table with one row per point it may
  /// be the name of a point: "mouthL" is "8.3".
  std::string name;
  std::string meaning;  ///< see above; "-": ignore the column
  double factor = 1;    ///< values are multiplied by it; finite, not 0
};

/// Rules; the first one that matches a column applies.
using ColumnMap = std::vector<ColumnRule>;

/// "NAME=MEANING" or "NAME=MEANING*FACTOR". Errors: syntax (neither), invalid_argument (an unknown
/// meaning; a factor that is 0 or not a number).
Result<ColumnRule> parse_column_rule(std::string_view text);

/// Reads a table "column,meaning" or "column,meaning,factor" with one rule per line, fields
/// separated by commas, semicolons or tabs; lines that begin with # are ignored, as is a first line
/// that begins with "column". Errors, with the line: those of parse_column_rule(); truncated (no
/// rule).
Result<ColumnMap> read_column_map(std::string_view text);

/// Applies the rules to the columns of a table. Line numbers are preserved; columns without a rule
/// are unchanged. Errors: not_found (a rule that matches no column; the message lists the columns),
/// syntax (a value to be multiplied is not a number: line and column).
Result<std::string> rename_columns(std::string_view table, const ColumnMap& map);

}  // namespace animeme::exchange
