// Colours of vertices from factors and textures.
#pragma once

#include "tools/view/gltf/detail/primitive.h"

namespace animeme::gltf {

/// True if the piece has a texture and places in it.
bool has_texture(const RawPiece& piece);

/// Makes corners and materials of a piece of a head that is drawn with its materials; before
/// paint().
void add_corners(RawPiece& piece);

/// Gives each vertex its colour: COLOR_0 times factor times texture, head::kNoColour if the file
/// says nothing. Takes out the triangles that are more transparent than opaque (less than
/// alphaCutoff for masks); those of a piece with materials become transparent, unless nothing is
/// left of them.
void paint(RawPiece& piece);

}  // namespace animeme::gltf
