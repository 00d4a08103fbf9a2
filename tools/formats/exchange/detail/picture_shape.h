/// @file
/// The shape of the picture in which landmarks were found: square pixels, and depth in their unit.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/exchange/detail/landmark_columns.h"
#include "tools/formats/exchange/detail/landmark_rows.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

/// Errors: invalid_argument (a shape of pixels or scale of depth that is none).
Result<void> check_shape(const LandmarkTableOptions& options);

/// Makes x and y have one unit, and z, too, as landmarks.h tells; warns of what does not look like
/// a face.
void to_square_pixels(std::vector<LandmarkRow>& rows, const LandmarkColumns& columns,
                      const LandmarkTableOptions& options, std::vector<std::string>& warnings);

/// Whether z has the unit of x and y, told by how far the nose stands out; if not, it is warned of.
bool has_depth_of_a_face(const std::vector<LandmarkRow>& rows, const LandmarkColumns& columns,
                         std::vector<std::string>& warnings);

}  // namespace animeme::exchange
