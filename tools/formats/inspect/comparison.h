/// @file
/// Differences of faces and bodies, told.
#pragma once

#include <optional>
#include <string>

#include "fap/compare.h"
#include "tools/formats/inspect/body_difference.h"

namespace animeme::inspect {

/// What two inputs were compared in.
struct Comparison {
  std::optional<fap::Difference> face;  ///< nothing: one of them cannot hold a face
  std::optional<BodyDifference> body;   ///< nothing: one of them cannot hold a body

  /// Equal in all that was compared.
  bool equal() const { return (!face || face->equal()) && (!body || body->equal()); }
};

/// Everything as JSON text; parameters that neither has are left out.
std::string comparison_json(const Comparison& comparison);

/// A line, or a line and a table of the parameters that differ, for the face and for the body.
std::string comparison_text(const Comparison& comparison);

}  // namespace animeme::inspect
