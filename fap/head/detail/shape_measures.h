// What shapes do to a head, measured at its feature points. Internal.
#pragma once

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// How the shapes of a rig close the lips: measured where the head has the feature points, else as
/// their FAPs say.
fap::LipMeasures lip_measures(const Head& head, const Rig& rig);

/// The shapes of a head with the FAPs of the mouth (groups 2 and 8, jaw and lips) as its feature
/// points really move. A name says what a shape is of, not how far a maker took it: the U of one
/// head rounds the lips, that of another only opens them a little. Left as their tables say are
/// moods, which FAP 2 shows by name, and all shapes of a head with ARKit's jaw, whose weights
/// others expect as ARKit's.
std::vector<ShapeControl> measured_shapes(const Head& head, const Rig& rig);

}  // namespace animeme::head::detail
