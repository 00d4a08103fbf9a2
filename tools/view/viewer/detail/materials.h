// The materials of a head for the page: what materials.js and model.js read.
#pragma once

#include <span>

#include "fap/head/model.h"
#include "tools/view/viewer/detail/bytes.h"

namespace animeme::viewer::detail {

/// The corners and facets of a part, those of one material together; null if it has none. What the
/// page reads of the result stands in README.md.
tools::Json write_facets(const head::Mesh& mesh, Bytes& out);

/// Materials and, once each, the files of their pictures: {"materials", "pictures"}.
tools::Json write_materials(std::span<const head::Material> materials, Bytes& out);

}  // namespace animeme::viewer::detail
