// Colours of vertices as a texture, for players that show nothing else.
#pragma once

#include "fap/xml/detail/tga.h"

namespace animeme::head::detail {

/// A texture and a place on it for each vertex.
struct ColourPlane {
  TgaPicture picture;
  std::vector<TexturePlace> places;
};

/// A plane through the colours of a mesh is drawn, and each vertex lies on it where its colour is.
/// So between vertices the texture runs as the colours do, whatever the form of the mesh: there are
/// no islands, no seams, and nothing is seen of what lies behind. What the plane misses, colours
/// beside it, is put right texel by texel where vertices lie. Vertices keep off the borders by a
/// quarter, so that coarser copies of the texture (mipmaps), which repeat beyond them, are as
/// right. The mesh has colours and at least one vertex.
ColourPlane colour_plane(const Mesh& mesh);

}  // namespace animeme::head::detail
