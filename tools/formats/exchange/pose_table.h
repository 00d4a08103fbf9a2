/// @file
/// Tables of poses, as saved by a spreadsheet: one row per pose, one column per control.
///
///     pose,jawOpen,mouthPucker
///     rest,0.02,0
///     AA,0.8,0.05
#pragma once

#include <string>
#include <string_view>

#include "dam/signal/gain_offset.h"
#include "fap/result.h"

namespace animeme::exchange {

/// Whether fields may be empty.
enum class Blanks : unsigned char {
  refused,  ///< every pose needs a value for every control
  allowed,  ///< they become NaN: the pose leaves the control undefined
};

/// Reads a table with commas, semicolons or tabs and a decimal point. The column of names is called
/// "pose" or "key". Errors, with line and column: truncated, syntax (fields, numbers, duplicate
/// names), not_found (no column of names, no control).
Result<dam::Poses> read_pose_table(std::string_view text, Blanks blanks = Blanks::refused);

/// Writes a table with six decimals. `first` is the header of the column of names.
std::string write_pose_table(const dam::Poses& poses, std::string_view first = "pose");

}  // namespace animeme::exchange
