/// @file
/// Tables of poses: a row a pose, a column a control, as a spreadsheet saves them.
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

/// Whether a field may have nothing in it.
enum class Blanks : unsigned char {
  refused,  ///< every pose has a value of every control
  allowed,  ///< they become NaN: the pose says nothing of that control
};

/// Reads one with commas, semicolons or tabs, a point as decimal sign. The column of names is
/// called "pose" or "key". Errors, with line and column: truncated, syntax (fields, numbers, names
/// twice), not_found (no column of names, no control).
Result<dam::Poses> read_pose_table(std::string_view text, Blanks blanks = Blanks::refused);

/// Writes one, six digits behind the point. `first` is what the column of names is called.
std::string write_pose_table(const dam::Poses& poses, std::string_view first = "pose");

}  // namespace animeme::exchange
