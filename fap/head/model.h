/// @file
/// A head by code: no file, no foreign licence, the same bytes on each call.
///
///     animeme::head::Head head = *animeme::head::make_head();
///     animeme::head::Rig rig = animeme::head::make_rig(head);  // rig.h
///     animeme::head::Pose pose = animeme::head::pose(rig, frame);
///
/// Heads of others: see own_head.h.
///
/// Lengths are centimetres. Axes as everywhere in Animeme: +X to the person's left, +Y up, +Z
/// forward. The origin lies between the centres of the eyes, at the depth of the ears.
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
#include "fap/head/coat.h"
#include "fap/head/vector.h"
#include "fap/result.h"

/// Heads, and the rig that lets FAPs move them.
namespace animeme::head {

using Triangle = std::array<std::uint32_t, 3>;  ///< counterclockwise seen from outside

/// How a surface takes light. Colours are those of the vertices.
enum class Material : std::uint8_t { skin, eye, teeth, wet, hair, cloth };

/// Triangles with a colour for each vertex. The vectors of vertices have the same length.
struct Mesh {
  std::vector<Vec3> positions;         ///< cm
  std::vector<Triangle> triangles;     ///< corners counter-clockwise, seen from outside
  std::vector<Vec3> colours;           ///< linear RGB, 0..1
  std::vector<float> occlusion;        ///< 1: open sky, 0: no light gets here
  Material material = Material::skin;  ///< how light falls on it
  /// How it is drawn if the head has coats, else empty. Facets are triangles of corners, in the
  /// order of `triangles`; behind these the veils: triangles that are mostly transparent, which
  /// are drawn, but neither move nor shade anything.
  std::vector<Corner> corners;
  std::vector<Triangle> facets;      ///< indices of `corners`
  std::vector<std::uint16_t> coats;  ///< of each facet, index of Head::coats
};

/// The meshes of a head.
enum class Part : std::uint8_t {
  skin,  ///< face, ears, neck, sockets of the eyes, lips and the bag of the mouth: closed surfaces
  left_eye,
  right_eye,
  upper_teeth,  ///< with their gums, fixed in the head
  lower_teeth,  ///< with their gums, turn with the jaw
  tongue,
  hair,
  brows,   ///< left, then right, the same number of vertices
  lashes,  ///< the same
  body,    ///< shoulders in clothes; do not move
};
inline constexpr int kPartCount = 10;  ///< values of Part
/// "skin", "left_eye" ...
extern const std::array<std::string_view, kPartCount> kPartNames;

/// A ball that looks along +Z.
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

  bool exists() const { return vertex != kMissing; }  ///< false: the head does not have this point
};

/// Vertices of the skin that meet: the contact line of the lips, or the rims of two lids.
struct ContactPair {
  std::uint32_t upper = 0;  ///< vertex of the upper rim
  std::uint32_t lower = 0;  ///< vertex of the lower rim
};

/// What a rig can use if the maker of a head knows it; see rig.h.
struct Seams {
  std::vector<ContactPair> lips;                 ///< from the right corner to the left one
  std::array<std::vector<ContactPair>, 2> lids;  ///< left eye, right eye
  /// For each skin vertex: how far it goes along with a lid, 0..1: upper and lower lids of the left
  /// and right eye. Empty: from the feature points alone.
  std::array<std::vector<float>, 4> lid_weights;
  /// For each skin vertex: how far it turns with the jaw, inside the mouth. Empty: nowhere.
  std::vector<float> jaw_weights;
  /// For each skin vertex: 1 is free to move, 0 slides along itself, as below hair. Empty:
  /// all are free.
  std::vector<float> freedom;
  /// For each skin vertex: 1 turns with the head, 0 stays with the body. Empty: by its height.
  std::vector<float> neck_weights;
};

/// A shape that somebody modelled, such as ARKit's "jawOpen", and the FAPs that show the same at
/// weight 1. A head with shapes is moved by the weights whose FAPs come nearest to those wanted.
struct ShapeControl {
  std::string name;  ///< as its maker calls it
  fap::Frame faps;   ///< what it shows at weight 1
  /// Its channel (fap::find_arkit()) if it is one of ARKit's, fap::kWholeFace of a mood such as
  /// joy, which is used where it does much, not for a little of a smile; nothing: another.
  std::optional<int> arkit = {};
  /// 1..14: the viseme of FAP 1 that its maker says it is. A frame whose mouth is that of FAP 1
  /// alone shows it as it is.
  std::optional<int> viseme = {};
};

/// Target::control of the first shape of a head; smaller numbers are FAPs.
inline constexpr int kFirstShape = fap::kFapCount + 1;
/// Value of a control at which a shape is fully shown.
inline constexpr float kFullShape = 1024;

/// What one unit of a control does to the vertices of a part.
struct Target {
  int control = 0;         ///< number of a FAP (3..68), or kFirstShape + index of a shape
  Part part = Part::skin;  ///< which mesh is moved
  std::vector<std::uint32_t> vertices;  ///< ascending
  std::vector<Vec3> deltas;             ///< cm for one unit; as many as vertices
  /// Values between which it moves: it counts clamp(value, low, high) - clamp(0, low, high) units.
  /// Several targets make a curve of straight pieces.
  float low = -std::numeric_limits<float>::infinity();
  float high = std::numeric_limits<float>::infinity();  ///< see `low`

  /// Units at this value of the control.
  float units(float value) const {
    return std::clamp(value, low, high) - std::clamp(0.0f, low, high);
  }
};

/// A head at rest: meshes in cm, feature points, and what is known of how it moves.
struct Head {
  std::string name;                    ///< for people
  double centimetres = 1;              ///< of one unit of the file that it comes from
  std::array<Mesh, kPartCount> parts;  ///< by Part; absent ones are empty
  std::vector<Coat> coats;             ///< materials of heads of others; empty: see Mesh::colours
  std::array<Eye, 2> eyes;             ///< left, right
  /// All 84 points of the standard, in the order of fap::kFeaturePoints. 7.1, the top of the spine,
  /// is no vertex: it is neck_pivot.
  std::array<FeaturePoint, 84> feature_points;
  fap::Fapu fapu;   ///< measured on them
  Vec3 jaw_axis;    ///< the jaw turns about the X direction through this point
  Vec3 neck_pivot;  ///< the head turns about this point: 7.1, top of the spine
  Seams seams;      ///< may be empty
  std::vector<std::uint32_t> lash_anchors;  ///< skin vertex at the root of each vertex of lashes
  /// Empty: FAPs move it.
  std::vector<ShapeControl> shapes;
  /// How much wider lips open than a clip says: see fap/wider.h.
  double mouth_gain = 1;
  /// How it moves, as its maker says. Empty: make_rig() finds it from the feature points.
  std::vector<Target> targets;
  /// The targets are those that make_rig() found before: values beyond what people do are eased
  /// (Rig::reaches) as if it found them again.
  bool eased = false;

  Mesh& part(Part p) { return parts[std::size_t(p)]; }              ///< one of the meshes
  const Mesh& part(Part p) const { return parts[std::size_t(p)]; }  ///< one of the meshes
  /// A feature point by its id ("2.1"); missing for ids that do not exist.
  FeaturePoint point(std::string_view id) const;
  /// Its place; neck_pivot for 7.1, the origin if it is missing.
  Vec3 at(std::string_view id) const;
};

/// The chin: 2.1, or about where it is if the head does not have the point.
Vec3 chin_of(const Head& head);

/// Hair that make_head() knows.
enum class HairStyle : std::uint8_t { bob, short_cut, fringe };

/// Sizes in cm and colours (sRGB, 0xRRGGBB) of a head. Sizes may be changed within about a
/// quarter; beyond that parts get into each other's way.
struct HeadParameters {
  std::string name = "woman";             ///< becomes Head::name
  double density = 1;                     ///< 0.5..2; vertices of the skin grow with its square
  double scale = 1;                       ///< of the whole head
  double skull_width = 7.5;               ///< half width
  double skull_height = 7.6;              ///< above skull centre
  double face_width = 6.1;                ///< half width at the cheek bones
  double jaw_width = 3.15;                ///< half width of the lower face
  double chin_drop = 9.8;                 ///< chin below the eyes
  double chin_size = 1.3;                 ///< radius
  double cheek = 2.3;                     ///< roundness of the cheeks
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
  HairStyle hair = HairStyle::bob;        ///< see HairStyle
  std::uint32_t skin_colour = 0xE8AC88;   ///< sRGB
  std::uint32_t lip_colour = 0xC4605C;    ///< sRGB
  std::uint32_t cheek_colour = 0xDE8468;  ///< sRGB
  std::uint32_t iris_colour = 0x5F6A42;   ///< sRGB
  std::uint32_t hair_colour = 0x4A2A1B;   ///< sRGB
  std::uint32_t brow_colour = 0x3C2418;   ///< sRGB
  std::uint32_t cloth_colour = 0x3F6F86;  ///< sRGB
};

/// "woman", "man", "child"; nothing for other names.
std::optional<HeadParameters> head_parameters(std::string_view name);
/// The names that head_parameters() knows.
extern const std::array<std::string_view, 3> kHeadNames;

/// Makes a head. Deterministic; about half a second.
/// Errors: invalid_argument if a size is not finite and positive (smile, nose_bridge, brow_ridge
/// and lashes may be 0), or the density is not in 0.5..2.
Result<Head> make_head(const HeadParameters& parameters = {});

}  // namespace animeme::head
