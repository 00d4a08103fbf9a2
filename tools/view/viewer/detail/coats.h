// The coats of a head for the page: what coats.js and model.js read.
#pragma once

#include <span>

#include "fap/head/model.h"
#include "tools/view/viewer/detail/bytes.h"

namespace animeme::viewer::detail {

/// The corners and facets of a part, those of one coat together; null if it has none. What the
/// page reads of the result stands in README.md.
tools::Json write_facets(const head::Mesh& mesh, Bytes& out);

/// Coats and, once each, the files of the pictures that they wear: {"coats", "pictures"}.
tools::Json write_coats(std::span<const head::Coat> coats, Bytes& out);

}  // namespace animeme::viewer::detail
