/// @file
/// Meshes of VRML97 files (.wrl), such as those of Xface and of older tools for faces.
///
///     animeme::Result<std::vector<animeme::head::Piece>> pieces = animeme::head::read_wrl(text);
///
/// What is read: Group, Transform and other grouping nodes, Shape, IndexedFaceSet with Coordinate
/// and Color, Appearance with the diffuseColor of its Material, DEF and USE. All other nodes and
/// fields are passed over (lights, scripts, PROTO; textures, which only read_fdp() looks at).
/// Source: ISO/IEC 14772-1.
#pragma once

#include <span>

#include "fap/head/own_head.h"

namespace animeme::head {

/// Reads the meshes of a VRML97 text, one piece for each Shape that has a triangle, in the order of
/// the file. Places are those of the scene (Transform applied), in the unit of the file (by the
/// standard: metres; few files keep to it). Vertices stay as they are in Coordinate, also those
/// that no polygon uses. Polygons become fans of triangles. Colours become linear light; a Shape
/// with neither Color nor Material gets none. Piece::name is the DEF name of the Shape, else of its
/// geometry, else of the nearest group; Piece::material that of the Material.
/// `notes`, if given, gets a sentence for each thing that was put right.
///
/// Errors, with line and column: syntax (no VRML97, a field that breaks the grammar, USE of an
/// unknown name), truncated (the text ends within a node), out_of_range (an index that names no
/// vertex, numbers that are not finite, more than 100 levels or 500000 vertices), unsupported
/// (VRML 1.0, compressed files), not_found (no mesh in it).
Result<std::vector<Piece>> read_wrl(std::string_view text,
                                    std::vector<std::string>* notes = nullptr);

/// A place on a texture: (0, 0) is its lower left corner, (1, 1) the upper right one.
struct TexturePlace {
  float u = 0;  ///< to the right
  float v = 0;  ///< up
};

/// The texture of a piece.
struct PieceTexture {
  std::string file;                  ///< its name; empty: the piece has none
  std::vector<TexturePlace> places;  ///< of the vertices
};

/// Writes pieces as VRML97, a Shape with DEF for each in the order given, so that read_wrl() gives
/// the same back: names without blanks, colours to a thousandth. Written so that plain scanners
/// such as that of Xface can read it: one blank around each bracket, no DEF for the geometry (Xface
/// calls it FILE_0, FILE_1 ... then). Occlusion and weights of the neck are left out.
/// `textures`, if given, are those of the pieces, in their order; files that they name are not
/// written. Viewers show a texture in place of the colours.
std::string write_wrl(std::span<const Piece> pieces, std::span<const PieceTexture> textures = {});

}  // namespace animeme::head
