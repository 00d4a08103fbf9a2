// Which part each vertex of a head of others belongs to.
#pragma once

#include "fap/head/own_head.h"

namespace animeme::head::detail {

/// For each vertex of a piece its part, or kPartCount if it is not shown, as what part_by_name()
/// does not want and lashes without colours. Connected vertices stay
/// together. Eyes are told apart by their side of x = `middle`, teeth by their side of
/// y = `mouth`, each connected body for itself.
std::vector<std::uint8_t> parts_of(const Piece& piece, float middle, float mouth);

/// For each vertex the lowest number of a vertex that it is connected with.
std::vector<std::uint32_t> bodies_of(const Mesh& mesh);

}  // namespace animeme::head::detail
