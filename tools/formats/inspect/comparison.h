/// @file
/// Report on differences of faces and bodies.
#pragma once

#include <optional>
#include <string>

#include "fap/compare.h"
#include "tools/formats/inspect/body_difference.h"

namespace animeme::inspect {

/// Result of comparing two inputs.
struct Comparison {
  std::optional<fap::Difference> face;  ///< nullopt: one of them cannot contain a face
  std::optional<BodyDifference> body;   ///< nullopt: one of them cannot contain a body

  /// Equal in everything that was compared.
  bool equal() const { return (!face || face->equal()) && (!body || body->equal()); }
};

/// The comparison as JSON text, without parameters that neither has.
std::string comparison_json(const Comparison& comparison, bool damaged = false);

/// A line, and a table if parameters differ, for the face and for the body.
std::string comparison_text(const Comparison& comparison);

}  // namespace animeme::inspect
