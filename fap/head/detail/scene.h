// The scene graph of VRML97, as far as it carries meshes; XMT-A has the same nodes in other
// clothes. A reader makes nodes and hands them their fields; scene_pieces() flattens the graph.
#pragma once

#include <memory>
#include <span>

#include "fap/head/own_head.h"
#include "fap/head/wrl.h"

namespace animeme::head::detail {

struct SceneNode;
using SceneNodePtr = std::shared_ptr<SceneNode>;

/// What a file gives as the value of a field: numbers, nodes or words, whichever it is.
struct SceneValue {
  std::vector<double> numbers;
  std::vector<SceneNodePtr> nodes;
  std::vector<std::string> words;  ///< also TRUE and FALSE
  Position where;                  ///< of its first token
};

/// Levels of nodes within nodes that readers accept.
inline constexpr int kDeepestNode = 100;

/// A node. Which members count depends on its type.
struct SceneNode {
  std::string type;  ///< "Transform", "IndexedFaceSet" ...
  std::string name;  ///< of DEF; may be empty
  Position where;
  /// Nodes in the order of the file: children of groups, the parts of shapes.
  std::vector<SceneNodePtr> children;
  int height = 0;  ///< levels of nodes below
  // Transform
  Vec3 translation, centre;
  Vec3 scale = {1, 1, 1};
  std::array<double, 4> rotation = {0, 0, 1, 0};           ///< axis, rad
  std::array<double, 4> scale_orientation = {0, 0, 1, 0};  ///< the same
  // Coordinate: points, Color: colours
  std::vector<Vec3> values;
  // TextureCoordinate, ImageTexture
  std::vector<TexturePlace> texture_places;
  std::vector<std::string> urls;
  // IndexedFaceSet
  std::vector<std::int32_t> coord_index, colour_index, texture_index;
  Position coord_where, colour_where;
  bool colour_per_vertex = true;
  bool counterclockwise = true;
  // Material
  std::optional<Vec3> diffuse;

  /// The first child of this type; nothing if there is none.
  const SceneNode* child(std::string_view child_type) const;
};

/// Puts the value into the node. Fields that no mesh needs are left alone.
/// Errors: syntax (numbers that do not come in threes, an index that is no whole number),
/// out_of_range (not finite, or nodes nested more than kDeepestNode levels).
Result<void> set_field(SceneNode& node, std::string_view field, SceneValue value);

/// The matrix of a Transform.
Transform placement(const SceneNode& transform);

/// The texture of a piece and where its corners lie on it.
struct ScenePicture {
  struct Corner {
    std::uint32_t vertex = 0;
    TexturePlace place;
  };
  std::vector<std::string> urls;  ///< any one of them; empty: the piece has no texture
  std::vector<Corner> corners;    ///< of all polygons
  std::string problem;            ///< why it cannot be used: the end of a sentence
};

/// An IndexedFaceSet at its place.
struct ScenePiece {
  Piece piece;  ///< name: DEF of the shape, else of its faces, else of the nearest group
  std::string geometry_name;            ///< DEF of the IndexedFaceSet
  bool first_use = true;                ///< false: reached a second time, by USE
  const SceneNode* faces = nullptr;     ///< lives as long as the graph
  std::vector<const SceneNode*> above;  ///< groups, the outermost first
  Transform place;
  ScenePicture picture;
};

/// The meshes below `roots` in the order of the file, also those without a triangle. Polygons
/// become fans, colours of faces means at their vertices, colours linear. Vertices are those of the
/// Coordinate nodes, all of them and in their order.
/// Errors: out_of_range (an index that names no vertex or colour, USE that multiplies the
/// scene beyond 4 million vertices or 200 000 nodes).
Result<std::vector<ScenePiece>> scene_pieces(std::span<const SceneNodePtr> roots);

/// The nodes at the top of a VRML97 text. Errors: see read_wrl().
Result<std::vector<SceneNodePtr>> wrl_scene(std::string_view text,
                                            std::vector<std::string>* notes = nullptr);

}  // namespace animeme::head::detail
