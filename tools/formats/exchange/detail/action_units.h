// Tables of action units (FACS), as OpenFace, LibreFace and Py-Feat write them.
#pragma once

#include <string_view>

#include "fap/result.h"
#include "tools/formats/exchange/detail/shape_table.h"

namespace animeme::exchange {

/// Whether a header line names at least three action units with an intensity ("AU12_r", "AU12").
bool is_action_unit_table(std::string_view header);

/// An action unit moves the shapes that ICT-FaceKit lists for it, both sides alike (FaceKit's
/// FACS table, MIT); AU 25 and 26, which it lacks, lips that part and a jaw that drops. Intensities
/// are 0 to 5 in OpenFace ("_r", "_R"), else 0 to 1 if no value exceeds 1; the presence ("_c") is
/// used for units without intensity. gaze_angle_x and _y become the gaze, pose_Rx, _Ry and _Rz the
/// head, in rad. Rows of which `success` is 0 are left out. Errors: those of tables.
Result<ShapeTable> action_units_to_shapes(std::string_view text);

}  // namespace animeme::exchange
