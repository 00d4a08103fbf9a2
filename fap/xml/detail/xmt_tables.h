// FaceDefTables: what FAPs do to the meshes of a face; and which vertices the places of
// featurePointsCoord are.
#pragma once

#include "fap/xml/detail/xmt_scene.h"

namespace animeme::head::detail {

/// What the tables are about. `pieces` are all of the scene graph; those without a triangle have no
/// place in `source`.
struct XmtFace {
  Source source;
  std::vector<ScenePiece> pieces;
  std::vector<std::size_t> index;  ///< of each piece in source.pieces; kNoPiece: none
  fap::Fapu fapu;
};
inline constexpr std::size_t kNoPiece = ~std::size_t(0);

/// Adds the <FaceDefTables> of an <FDP> to face.source: FaceDefMesh as targets, FaceDefTransform as
/// targets or as the centres of eyes, jaw and neck.
/// Errors: syntax (numbers that do not fit together), out_of_range (fapID, a vertex that the mesh
/// does not have).
Result<void> read_tables(const XmlElement& fdp, XmtScene& scene, XmtFace& face);

/// Sets face.source.points and the pivot of the neck; see read_xmt(). Closed lips have two vertices
/// in one place: of vertices that are equally near, the one is taken that moves as the FAPs of the
/// point say, or, without tables, that has its lip on its side. Notes distances.
void set_points(const fap::FeaturePoints& places, XmtFace& face);

}  // namespace animeme::head::detail
