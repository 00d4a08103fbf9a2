/// @file
/// Procedural heads: no input file, no third-party licence, the same bytes on each call.
///
///     animeme::head::Head head = *animeme::head::make_head();
///     animeme::head::Rig rig = animeme::head::make_rig(head);  // rig.h
///     animeme::head::Pose pose = animeme::head::pose(rig, frame);
///
/// Heads from files: see own_head.h.
///
/// Lengths are centimetres. Axes as everywhere in Animeme: +X to the person's left, +Y up, +Z
/// forward. The origin is between the centres of the eyes, at the depth of the ears.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/fapu.h"
#include "fap/frame.h"
#include "fap/head/material.h"
#include "fap/head/vector.h"
#include "fap/result.h"

/// Heads, and the rig by which FAPs move them.
namespace animeme::head {

using Triangle = std::array<std::uint32_t, 3>;  ///< counterclockwise seen from outside

/// Built-in shading of a surface. Colours are those of the vertices.
enum class SurfaceKind : std::uint8_t { skin, eye, teeth, wet, hair, cloth };

/// The surface of skin below the size of triangles, at a vertex.
struct Grain {
  float relief = 0;  ///< strength of pores and small folds, 0..1; -1..0: of the lines of lips
  float gloss = 1;   ///< strength of the highlight, 0..2
};

/// Triangles with a colour per vertex. The vectors of vertices have the same length.
struct Mesh {
  std::vector<Vec3> positions;              ///< cm
  std::vector<Triangle> triangles;          ///< counterclockwise, seen from outside
  std::vector<Vec3> colours;                ///< linear RGB, 0..1
  std::vector<float> occlusion;             ///< ambient occlusion; 1: unoccluded
  SurfaceKind surface = SurfaceKind::skin;  ///< see SurfaceKind
  std::vector<Grain> grain;                 ///< of vertices; empty: smooth
  /// How it is drawn if the head has materials, else empty. Facets are triangles of corners, in the
  /// order of `triangles`, followed by the mostly transparent triangles, which are drawn,
  /// but neither move nor shade anything.
  std::vector<Corner> corners;
  std::vector<Triangle> facets;          ///< indices of `corners`
  std::vector<std::uint16_t> materials;  ///< of each facet, index of Head::materials
};

/// The meshes of a head.
enum class Part : std::uint8_t {
  skin,  ///< face, ears, neck, eye sockets, lips and the inside of the mouth: closed surfaces
  left_eye,
  right_eye,
  upper_teeth,  ///< with their gums, fixed in the head
  lower_teeth,  ///< with their gums, turn with the jaw
  tongue,
  hair,
  brows,   ///< left, then right, the same number of vertices
  lashes,  ///< likewise
  body,    ///< shoulders in clothes; do not move
};
inline constexpr int kPartCount = 10;  ///< values of Part
/// "skin", "left_eye" ...
extern const std::array<std::string_view, kPartCount> kPartNames;

/// An eyeball that looks along +Z.
struct Eye {
  Vec3 centre;             ///< cm
  float radius = 0;        ///< cm
  float iris_radius = 0;   ///< of its border, seen from the front
  float pupil_radius = 0;  ///< at rest
};

inline constexpr std::uint32_t kMissing = ~0u;  ///< this head does not have the point

/// A feature point: a vertex of a part.
struct FeaturePoint {
  Part part = Part::skin;           ///< which mesh
  std::uint32_t vertex = kMissing;  ///< index of its vertex

  bool exists() const { return vertex != kMissing; }  ///< false: the head lacks this point
};

/// Skin vertices that touch: on the contact line of the lips, or the rims of two lids.
struct ContactPair {
  std::uint32_t upper = 0;  ///< vertex of the upper rim
  std::uint32_t lower = 0;  ///< vertex of the lower rim
};

/// Optional information for a rig; see rig.h.
struct Seams {
  std::vector<ContactPair> lips;                 ///< from the right corner to the left one
  std::array<std::vector<ContactPair>, 2> lids;  ///< left eye, right eye
  /// For each skin vertex: how far it follows a lid, 0..1: upper and lower lids of the left and
  /// right eye. Empty: derived from the feature points.
  std::array<std::vector<float>, 4> lid_weights;
  /// For each skin vertex: how far it turns with the jaw, inside the mouth. Empty: nowhere.
  std::vector<float> jaw_weights;
  /// For each skin vertex: 1 moves freely, 0 slides along the surface, as below hair. Empty: all
  /// move freely.
  std::vector<float> freedom;
  /// For each skin vertex: 1 turns with the head, 0 stays with the body. Empty: by its height.
  std::vector<float> neck_weights;
};

/// A modelled shape, such as ARKit's "jawOpen", and the FAPs that show the same at weight 1. A head
/// with shapes is moved by the weights whose FAPs best approximate the wanted ones.
struct ShapeControl {
  std::string name;  ///< as in the file
  fap::Frame faps;   ///< the same face as FAPs, at weight 1
  /// Its channel (fap::find_arkit()) if it is an ARKit shape; fap::kWholeFace for a mood such as
  /// joy, which is used for strong expressions, not for a slight smile; nullopt: another shape.
  std::optional<int> arkit = {};
  /// 1..14: the viseme of FAP 1 that its maker assigned. A frame whose mouth is given by FAP 1 only
  /// shows the shape unchanged.
  std::optional<int> viseme = {};
  /// 1..6: the expression of FAP 2 that its maker made as a whole face (joy, sadness ...); see
  /// control_values().
  std::optional<int> expression = {};
  /// Of such a shape what lies above the mouth: make_rig() adds it behind the shapes of a head.
  bool upper = false;
};

/// Target::control of the first shape of a head; smaller numbers are FAPs.
inline constexpr int kFirstShape = fap::kFapCount + 1;
/// Value of a control at which a shape is fully shown.
inline constexpr float kFullShape = 1024;

/// Displacement of the vertices of a part by one unit of a control.
struct Target {
  int control = 0;         ///< number of a FAP (3..68), or kFirstShape + index of a shape
  Part part = Part::skin;  ///< the mesh
  std::vector<std::uint32_t> vertices;  ///< ascending
  std::vector<Vec3> deltas;             ///< cm for one unit; as many as vertices
  /// Active range: the control counts as clamp(value, low, high) - clamp(0, low, high) units.
  /// Several targets form a piecewise linear curve.
  float low = -std::numeric_limits<float>::infinity();
  float high = std::numeric_limits<float>::infinity();  ///< see `low`

  /// Units at this value of the control.
  float units(float value) const {
    return std::clamp(value, low, high) - std::clamp(0.0f, low, high);
  }
};

/// A head at rest: meshes in cm, feature points, and how it moves.
struct Head {
  std::string name;                    ///< for people
  double centimetres = 1;              ///< per unit of the file that it comes from
  std::array<Mesh, kPartCount> parts;  ///< by Part; absent ones are empty
  std::vector<Material> materials;     ///< of heads from files; empty: Mesh::colours
  std::array<Eye, 2> eyes;             ///< left, right
  /// All 84 points of the standard, in the order of fap::kFeaturePoints. 7.1, the top of the spine,
  /// is not a vertex but neck_pivot.
  std::array<FeaturePoint, 84> feature_points;
  fap::Fapu fapu;   ///< measured on the feature points
  Vec3 jaw_axis;    ///< the jaw turns about the X direction through this point
  Vec3 neck_pivot;  ///< the head turns about this point: 7.1, top of the spine
  Seams seams;      ///< may be empty
  std::vector<std::uint32_t> lash_anchors;  ///< skin vertex at the root of each vertex of lashes
  /// Shapes by which it moves. Empty: FAPs move it directly.
  std::vector<ShapeControl> shapes;
  /// Scale of the mouth opening: see fap/wider.h.
  double mouth_gain = 1;
  /// Motion defined by the file. Empty: make_rig() derives it from the feature points.
  std::vector<Target> targets;
  /// The targets were made by make_rig() before: values beyond what people do are compressed
  /// (Rig::reaches) as for new ones.
  bool eased = false;

  Mesh& part(Part p) { return parts[std::size_t(p)]; }              ///< one of the meshes
  const Mesh& part(Part p) const { return parts[std::size_t(p)]; }  ///< one of the meshes
  /// A feature point by its id ("2.1"); missing for ids that do not exist.
  FeaturePoint point(std::string_view id) const;
  /// Its position; neck_pivot for 7.1, the origin if it is missing.
  Vec3 at(std::string_view id) const;
};

/// The chin: 2.1, or an estimate if the head does not have the point.
Vec3 chin_of(const Head& head);

/// Hair styles of make_head(): to the chin; cut and combed back; cut, over the forehead; to the
/// shoulders; combed back into a knot; in tight curls; none.
enum class HairStyle : std::uint8_t { bob, short_cut, fringe, lengthy, bun, curly, bald };

/// Glasses of make_head(): frames without lenses, part of the hair.
enum class Glasses : std::uint8_t { none, round, square };

/// Beards of make_head(): a shadow on the skin; `full` has hairs, too, which are part of the brows.
enum class Beard : std::uint8_t { none, stubble, full };

/// Sizes in cm and colours (sRGB, 0xRRGGBB) of a head. Sizes may be changed by about a quarter;
/// beyond that, parts intersect.
struct HeadParameters {
  std::string name = "woman";             ///< becomes Head::name
  double density = 1;                     ///< 0.5..2; the vertex count of the skin is quadratic
  double scale = 1;                       ///< of the whole head
  double skull_width = 7.5;               ///< half width
  double skull_height = 7.6;              ///< above skull centre
  double face_width = 5.95;               ///< half width at the cheek bones
  double jaw_width = 3.3;                 ///< half width of the lower face
  double chin_drop = 9.8;                 ///< chin below the eyes
  double chin_size = 1.3;                 ///< radius
  double cheek = 2.15;                    ///< roundness of the cheeks
  double brow_ridge = 0.08;               ///< bone above the eyes
  double neck = 3.75;                     ///< half width
  double eye_distance = 3.15;             ///< half the distance of the pupils
  double eye_radius = 1.72;               ///< of the ball
  double eye_opening = 1.42;              ///< height of the lid opening
  double eye_width = 3.1;                 ///< from corner to corner
  double iris = 0.89;                     ///< radius
  double nose_length = 3.55;              ///< tip below the eyes
  double nose_size = 0.64;                ///< radius of the tip
  double nose_bridge = 0.0;               ///< height of the bone
  double mouth_drop = 6.05;               ///< mouth below the eyes
  double mouth_width = 2.05;              ///< half width of the contact line
  double lip_fullness = 1.0;              ///< height of the lips
  double smile = 0.1;                     ///< height of the corners
  double brow_height = 2.35;              ///< above the eyes
  double brow_thickness = 0.26;           ///< half height
  double ear = 1.3;                       ///< size
  double lashes = 0.36;                   ///< length
  double lines = 0;                       ///< of age, 0..1: folds beside nose and mouth, forehead
  double freckles = 0;                    ///< 0..1, on nose and cheeks
  HairStyle hair = HairStyle::bob;        ///< see HairStyle
  Glasses glasses = Glasses::none;        ///< see Glasses
  Beard beard = Beard::none;              ///< see Beard
  std::uint32_t skin_colour = 0xE8AC88;   ///< sRGB
  std::uint32_t lip_colour = 0xC4605C;    ///< sRGB
  std::uint32_t cheek_colour = 0xDE8468;  ///< sRGB
  std::uint32_t iris_colour = 0x5F6A42;   ///< sRGB
  std::uint32_t hair_colour = 0x4A2A1B;   ///< sRGB
  std::uint32_t brow_colour = 0x3C2418;   ///< sRGB
  std::uint32_t cloth_colour = 0x3F6F86;  ///< sRGB
};

/// "woman", "man", "child"; nullopt for other names. More people: people.h.
std::optional<HeadParameters> head_parameters(std::string_view name);
/// The names that head_parameters() knows.
extern const std::array<std::string_view, 3> kHeadNames;

/// Makes a head. Deterministic; about a second.
/// Errors: invalid_argument if a size is not finite and positive (smile, nose_bridge, brow_ridge,
/// lashes, lines and freckles may be 0), or the density is not in 0.5..2.
Result<Head> make_head(const HeadParameters& parameters = {});

}  // namespace animeme::head
