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

/// Gives each part its material, and a colour to vertices of kNoColour: one for each part, lips
/// within the contour of the mouth if its points are known, pupil and iris on the eyes.
void colour_parts(Head& head);

/// Fills Mesh::occlusion of all parts that have none, looking at all parts from many sides.
/// Vertices that no side sees, such as those inside a closed mouth, get what little light there is.
void see_sky(Head& head);

}  // namespace animeme::head::detail
