/// @file
/// Tables with one row a point, as data frames are written: time, point, x, y, z.
#pragma once

#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/formats/exchange/column_map.h"

namespace animeme::exchange {

/// True if a header line has columns x and y, and one that says which point a row is about: point,
/// landmark, landmark_id, landmark_index, index, id, keypoint, marker, name, and the like.
bool is_long_table(std::string_view header);

/// The same with one row a frame. A frame ends where its time, number or face changes, or without
/// these where a point comes for the second time. Rules of `points` that name a point give it
/// another name, or leave it out ("-"). Errors, with line and column: syntax (fields, a point twice
/// in a frame, more than 5,000 points), truncated (no rows).
Result<std::string> long_to_wide(std::string_view text, const ColumnMap& points);

}  // namespace animeme::exchange
