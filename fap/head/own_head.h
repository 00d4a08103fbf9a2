/// @file
/// Heads from files: meshes, feature points and shapes become a Head.
///
///     animeme::head::Source source;
///     source.pieces.push_back({.name = "face", .mesh = mesh});
///     source.points.push_back({"2.1", 0, 966});         // the chin is vertex 966 of piece 0
///     ...
///     std::vector<std::string> notes;
///     animeme::head::Head head = *animeme::head::assemble(std::move(source), &notes);
///     animeme::head::Rig rig = animeme::head::make_rig(head);
///
/// Readers of files (fap/xml, tools/view/gltf, obj.h) fill a Source; assemble() does the common
/// steps: it sorts the pieces into parts by their names, turns the head upright, scales it to
/// centimetres and moves it to the origin, finds eyes, jaw, neck and FAPU, and flips inside-out
/// (clockwise) triangles.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/head/model.h"

namespace animeme::head {

/// An unknown colour; assemble() chooses one.
inline constexpr Vec3 kNoColour = {-1, -1, -1};

/// A mesh of a file. Any axes and any unit, the same for all pieces of a head.
struct Piece {
  std::string name;      ///< of the object or group; may be empty
  std::string material;  ///< its name; may be empty
  Mesh mesh;             ///< colours and occlusion may be empty, colours also kNoColour
  /// For each vertex: 1 turns with the head, 0 stays with the body. Empty: by height.
  std::vector<float> neck_weights;
  bool face = false;  ///< skin, whatever it is called: its shapes move lips and lids
};

/// The vertex of a feature point.
struct PiecePoint {
  std::string id;            ///< "2.1"
  std::size_t piece = 0;     ///< index of Source::pieces
  std::uint32_t vertex = 0;  ///< index within the piece
};

/// As Target, for a piece.
struct PieceTarget {
  int control = 0;                      ///< see Target
  std::size_t piece = 0;                ///< index of Source::pieces
  std::vector<std::uint32_t> vertices;  ///< ascending
  std::vector<Vec3> deltas;             ///< units of the file for one unit of the control
  float low = -std::numeric_limits<float>::infinity();  ///< see Target
  float high = std::numeric_limits<float>::infinity();  ///< see Target
};

/// Content of a file. Everything except the pieces may be empty.
struct Source {
  std::string name;                         ///< becomes Head::name
  std::vector<Piece> pieces;                ///< at least one
  std::vector<Material> materials;          ///< if there are any, each piece has facets
  std::vector<PiecePoint> points;           ///< feature points named in the file
  std::optional<fap::Fapu> fapu;            ///< in units of the file; else measured on the points
  std::vector<ShapeControl> shapes;         ///< see Head::shapes
  std::vector<PieceTarget> targets;         ///< see Head::targets
  std::array<std::optional<Vec3>, 2> eyes;  ///< centres, left and right
  std::optional<Vec3> jaw_axis;             ///< a point on it, units of the file
  std::optional<Vec3> neck_pivot;           ///< units of the file
  /// Centimetres per unit of the file. 0: derived from the eye distance, which is interpreted as
  /// metres, centimetres, millimetres or inches if that gives a plausible head; otherwise the head
  /// is scaled to the usual size.
  double centimetres = 0;
  /// The axes of the file are those of Head; otherwise they are found from the feature points.
  bool upright = false;
  /// Messages of the reader to the user; assemble() passes them on.
  std::vector<std::string> notes;
};

/// The part of a piece, by the words in its names ("Wolf3D_Teeth", "M_ScleraLeft", "eyelashes"),
/// not by what is within other words (Christopher is no top):
/// eyes, teeth and gums, tongue, hair (also hats and glasses), brows, lashes, body (clothes);
/// anything else is skin. nullopt: it should not be shown, such as the wet layer of an eye (cornea,
/// occlusion, tear line), which would hide what is behind it unless it is transparent. If the name
/// does not distinguish left and right eye, or upper and lower teeth, the result is left_eye or
/// lower_teeth; assemble() then uses the positions of the vertices.
std::optional<Part> part_by_name(std::string_view name, std::string_view material);

/// The word that part_by_name() goes by ("body"); empty: none.
std::string_view word_of_part(std::string_view name, std::string_view material);

/// The colour of a mesh with this name if nothing else is known; kNoColour for parts of one colour.
/// Linear RGB.
Vec3 colour_by_name(std::string_view name, std::string_view material);

/// Makes a head. `notes`, if given, gets those of the source, then a sentence for everything that
/// was guessed or is missing and that concerns the user, in a fixed order.
///
/// Errors: invalid_argument if there is no skin triangle, a triangle or point refers to a vertex
/// that does not exist, a length is not finite, two points have the same id, or measure_fapu()
/// refuses the points (with its message); not_found for ids that are not feature points, or if
/// neither `fapu` nor enough points to measure it nor the eyes are given (the message names the
/// missing ones). With shapes, FAPU may be missing: usual proportions are used then.
Result<Head> assemble(Source source, std::vector<std::string>* notes = nullptr);

}  // namespace animeme::head
