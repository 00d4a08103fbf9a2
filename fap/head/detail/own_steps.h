// The steps of assemble(): a head of others is checked, turned and scaled, cut into parts, coloured
// and lit.
#pragma once

#include "fap/head/own_head.h"

namespace animeme::head::detail {

/// The first thing in a source that cannot be: numbers that are none, vertices that do not exist,
/// unknown or double feature points, targets of nothing.
std::optional<Error> check(const Source& source);

/// Turns the head so that its axes are those of Head, if its points tell that they are not: to the
/// nearest of the 24 ways to name axes. True if it was turned.
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

/// For each vertex of a piece its part, or kPartCount if it is not shown, as what part_by_name()
/// does not want and lashes without colours. Connected vertices stay
/// together. Eyes are told apart by their side of x = `middle`, teeth by their side of
/// y = `mouth`, each connected body for itself.
std::vector<std::uint8_t> parts_of(const Piece& piece, float middle, float mouth);

/// For each vertex the lowest number of a vertex that it is connected with.
std::vector<std::uint32_t> bodies_of(const Mesh& mesh);

/// For each triangle of each part the index of its piece in the source.
using PieceOfTriangle = std::array<std::vector<std::uint32_t>, kPartCount>;

/// Triangles of a piece that were turned.
struct TurnedPiece {
  std::size_t piece = 0;
  std::size_t turned = 0;
  std::size_t triangles = 0;  ///< all that it has
};

/// Turns triangles that are wound the other way, so that they would show their inside. Parts and
/// feature points of the head are known, `es` is the distance of its eyes.
///
/// Judged are connected bodies, each for itself; within one, a triangle that its neighbours
/// contradict is as wrong as they are right. A body with three feature points of the face looks
/// forward there. Others are looked at from many sides (teeth and tongue also without the rest):
/// what is seen from outside has to be a front of it. Sheets that are open (cards of hair, masks)
/// are judged together with those of their piece. Bodies that nobody sees are as the rest of their
/// piece, or as all other pieces, if these are wrong as a whole. In doubt nothing is turned: right
/// bodies that show their inside (a neck from below, the back of a mask) do so from fewer sides
/// than four in five.
std::vector<TurnedPiece> turn_inside_out(Head& head, float es, const PieceOfTriangle& pieces);

/// Gives each part its material, and a colour to vertices of kNoColour: one for each part, lips
/// within the contour of the mouth and what lines the mouth if their points are known, pupil and
/// iris on the eyes. After see_sky().
void colour_parts(Head& head);

/// Fills Mesh::occlusion of all parts that have none, looking at all parts from many sides.
/// Vertices that no side sees, such as those inside a closed mouth, get what little light there is.
void see_sky(Head& head);

}  // namespace animeme::head::detail
