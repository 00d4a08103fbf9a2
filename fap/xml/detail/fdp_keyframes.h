// Faces that Xface shows as whole meshes: visemes of FAP 1 and expressions of FAP 2.
#pragma once

#include <string_view>
#include <vector>

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// An entity of an .fdp: a face by the name under which Xface looks it up.
struct FdpKeyframe {
  std::string_view alias;     ///< "aah"; fap/head/face_models.md lists them
  std::string_view category;  ///< "Viseme" or "Expression"
  /// Vertices of the parts of the plan, in its order; empty: as at rest.
  std::vector<std::vector<Vec3>> positions;
};

/// All of them at full strength. A part that stays in all has no positions in any, one that moves
/// in some has them in all.
std::vector<FdpKeyframe> fdp_keyframes(const Rig& rig, const std::vector<Part>& parts);

}  // namespace animeme::head::detail
