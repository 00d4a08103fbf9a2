// Closed tubes: brows, lashes, locks of hair.
#pragma once

#include <vector>

#include "fap/head/model.h"

namespace animeme::head::detail {

/// An oval cross section: its half axes are `up` and `out`.
struct Section {
  Vec3d place, up, out;
};

/// The triangles of a tube that is closed by flat ends: `rows` rings of `around` vertices from
/// `base` on.
void join_rings(std::uint32_t base, std::size_t rows, int around, Mesh& mesh);

/// Adds a tube of `around` vertices a section, closed by flat ends. Its triangles look outwards if
/// `up` is cross(out, along) and the tube runs along `along`. Adds no colours.
void add_tube(const std::vector<Section>& sections, int around, Mesh& mesh);

}  // namespace animeme::head::detail
