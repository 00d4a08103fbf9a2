// How much of the sky the vertices of a head see: soft shadows of meshes without any.
#pragma once

#include "fap/head/model.h"

namespace animeme::head::detail {

/// Fills Mesh::occlusion of all parts that have none, looking at all parts from many sides.
/// Vertices that no side sees, such as those inside a closed mouth, get what little light there is.
void see_sky(Head& head);

}  // namespace animeme::head::detail
