/// @file
/// Meshes of VRML97 files (.wrl), such as those of Xface and of older face tools.
///
///     animeme::Result<std::vector<animeme::head::Piece>> pieces = animeme::head::read_wrl(text);
///
/// Reads Group, Transform and other grouping nodes, Shape, IndexedFaceSet with Coordinate and
/// Color, Appearance with the diffuseColor of its Material, DEF and USE. All other nodes and fields
/// are skipped (lights, scripts, PROTO; textures, which only read_fdp() uses). Source: ISO/IEC
/// 14772-1.
#pragma once

#include <span>

#include "fap/head/own_head.h"

namespace animeme::head {

/// Reads the meshes of a VRML97 text, one piece for each Shape that has a triangle, in the order of
/// the file. Positions are those of the scene (Transform applied), in the unit of the file (by the
/// standard metres, which few files observe). Vertices stay as they are in Coordinate, including
/// those that no polygon uses. Polygons become triangle fans. Colours become linear light; a Shape
/// with neither Color nor Material gets none. Piece::name is the DEF name of the Shape, else of its
/// geometry, else of the nearest group; Piece::material that of the Material. `notes`, if given,
/// gets a sentence for each correction.
///
/// Errors, with line and column: syntax (not VRML97, a field that breaks the grammar, USE of an
/// unknown name), truncated (the text ends within a node), out_of_range (an index without a vertex,
/// numbers that are not finite, more than 100 levels or 500000 vertices), unsupported (VRML 1.0,
/// compressed files), not_found (no mesh).
Result<std::vector<Piece>> read_wrl(std::string_view text,
                                    std::vector<std::string>* notes = nullptr);

/// Texture coordinates: (0, 0) is the lower left corner, (1, 1) the upper right one.
struct TexturePlace {
  float u = 0;  ///< to the right
  float v = 0;  ///< up
};

/// The texture of a piece.
struct PieceTexture {
  std::string file;                  ///< its name; empty: the piece has none
  std::vector<TexturePlace> places;  ///< of the vertices
};

/// Writes pieces as VRML97, a Shape with DEF for each in the given order; read_wrl() gives the same
/// back: names without spaces, colours to a thousandth. Simple scanners such as that of Xface can
/// read it: one space around each bracket, no DEF for the geometry (Xface then calls it FILE_0,
/// FILE_1 ...). Occlusion and neck weights are omitted. `textures`, if given, are those of the
/// pieces, in their order; the files they name are not written. Viewers show a texture instead of
/// the colours.
std::string write_wrl(std::span<const Piece> pieces, std::span<const PieceTexture> textures = {});

}  // namespace animeme::head
