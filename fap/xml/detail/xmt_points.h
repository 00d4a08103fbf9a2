// Which vertices the places of featurePointsCoord are.
#pragma once

#include "fap/xml/detail/xmt_tables.h"

namespace animeme::head::detail {

/// Sets face.source.points and the pivot of the neck; see read_xmt(). Closed lips have two vertices
/// in one place: of vertices that are equally near, the one is taken that moves as the FAPs of the
/// point say, or, without tables, that has its lip on its side. Notes distances.
void set_points(const fap::FeaturePoints& places, XmtFace& face);

}  // namespace animeme::head::detail
