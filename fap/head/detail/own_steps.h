// The steps of assemble(): a head from a file is checked, rotated and scaled, split into parts,
// coloured and lit.
#pragma once

#include "fap/head/own_head.h"

namespace animeme::head::detail {

/// The first defect of a source: numbers that are not finite, vertices that do not exist, unknown
/// or duplicate feature points, targets of nothing.
std::optional<Error> check(const Source& source);

/// Rotates the head so that its axes are those of Head, if its points show that they are not: to
/// the nearest of the 24 axis permutations. True if it was rotated.
bool turn_upright(Source& source);

/// p becomes (p - origin) * scale, everywhere in the source.
void move_and_scale(Source& source, Vec3 origin, float scale);

/// Centimetres of a unit for eyes that are `distance` units apart, and its name ("metres"); an
/// empty name: no unit fits, the head is brought to usual size.
struct LengthUnit {
  double centimetres = 1;
  std::string_view name;
};
LengthUnit unit_of(double distance);

/// Place of a point; nothing if the source does not have it.
std::optional<Vec3> place_of(const Source& source, std::string_view id);

/// Between left and right point, if the source has both.
std::optional<Vec3> between(const Source& source, std::string_view left, std::string_view right);

/// For each vertex of a piece its part, or kPartCount if it is not shown, such as pieces without a
/// part_by_name() and lashes without colours. Connected vertices stay together. Left and right eye
/// are distinguished by the side of x = `middle`, upper and lower teeth by the side of y = `mouth`,
/// for each connected body.
std::vector<std::uint8_t> parts_of(const Piece& piece, float middle, float mouth);

/// For each vertex the lowest number of a vertex that it is connected with.
std::vector<std::uint32_t> bodies_of(const Mesh& mesh);

/// For each triangle of each part the index of its piece in the source.
using PieceOfTriangle = std::array<std::vector<std::uint32_t>, kPartCount>;

/// Triangles of a piece that were flipped.
struct TurnedPiece {
  std::size_t piece = 0;
  std::size_t turned = 0;
  std::size_t triangles = 0;  ///< all that it has
};

/// Flips inside-out triangles. Parts and feature points of the head are known, `es` is the distance
/// of its eyes.
///
/// Each connected body is judged by itself; within one, triangles are first made consistent with
/// their neighbours. A body with three feature points of the face has to look forward there. Others
/// are viewed from many sides (teeth and tongue also without the rest): what is visible from
/// outside has to be front faces. Open sheets (hair cards, masks) are judged together with those of
/// their piece. Invisible bodies are treated like the rest of their piece, or like all other
/// pieces, if these are wrong as a whole. In doubt nothing is flipped: correct bodies that show
/// their inside (a neck from below, the back of a mask) do so from fewer sides than four in five.
std::vector<TurnedPiece> turn_inside_out(Head& head, float es, const PieceOfTriangle& pieces);

/// Gives each part its material, and a colour to vertices of kNoColour: one for each part, lips
/// within the contour of the mouth and what lines the mouth if their points are known, pupil and
/// iris on the eyes. After see_sky().
void colour_parts(Head& head);

/// Fills Mesh::occlusion of all parts that have none, looking at all parts from many sides.
/// Vertices that no side sees, such as those inside a closed mouth, get what little light there is.
void see_sky(Head& head);

}  // namespace animeme::head::detail
