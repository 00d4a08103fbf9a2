// Meshes of a file as triangles in the world at rest, with what moves them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fap/head/model.h"
#include "tools/view/gltf/detail/accessor.h"
#include "tools/view/gltf/detail/joints.h"
#include "tools/view/gltf/detail/nodes.h"
#include "tools/view/gltf/detail/texture.h"
#include "tools/view/gltf/detail/vrm.h"

namespace animeme::gltf {

/// What a morph target of a mesh does to a piece, in the world.
struct PieceMorph {
  std::size_t shape = 0;  ///< index of its name, see ShapeNames
  Moves moves;
};

inline constexpr std::uint32_t kNewVertex = ~0u;

/// Where a vertex of the file is.
struct FileVertex {
  std::uint32_t number = 0;
  std::uint32_t vertex = 0;  ///< of the piece
};

/// One primitive of a node's mesh. Vectors of vertices have the length of `positions`, or none.
struct RawPiece {
  std::size_t node = 0;
  std::string name;  ///< of the node and the mesh
  const Paint* paint = nullptr;
  std::vector<head::Vec3> positions;
  std::vector<head::Triangle> triangles;
  std::vector<Uv> uvs;
  std::vector<Colour> colours;      ///< COLOR_0
  std::vector<head::Vec3> normals;  ///< fewer than positions: of those made later
  std::vector<float> neck_weights;  ///< see head::Piece
  bool on_jaw = false;              ///< some of it hangs on the jaw
  bool face = false;                ///< see head::Piece
  std::vector<PieceMorph> morphs;   ///< by shape
  /// From add_corners() on, of heads that are drawn with their materials. Corner::vertex is the
  /// vertex.
  std::vector<head::Corner> corners;
  std::vector<head::Triangle> transparent;  ///< triangles that are mostly transparent
  std::vector<std::uint16_t> materials;     ///< of triangles, then of transparent ones
  std::vector<head::Triangle> facets;  ///< after weld(), in place of `transparent`: see head::Mesh
  /// Numbers in the file: through the primitives of the node's mesh, of each the vertices that have
  /// a triangle, as Blender counts them. kNewVertex: divided triangles made it.
  std::vector<std::uint32_t> numbers;
  std::vector<FileVertex> file_vertices;  ///< after weld(), in place of `numbers`; by number
};

/// Names of morph targets in the order in which they are met; the same name in two meshes is one
/// shape.
class ShapeNames {
 public:
  std::size_t index_of(const std::string& name);
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> numbers_;
};

/// Reads all meshes of the nodes that are shown; of levels of detail ("head_LOD0") the finest.
class MeshReader {
 public:
  MeshReader(const File& file, const std::vector<Node>& nodes, const HeadJoints& joints,
             Paints& paints, const ShapeRules& rules)
      : file_(file),
        nodes_(nodes),
        shares_(neck_shares(nodes, joints)),
        jaw_(nodes_below(nodes, joints.jaw)),
        paints_(paints),
        expressions_(vrm_expressions(file, nodes, rules)) {}

  /// Errors: see read_head().
  Result<std::vector<RawPiece>> read(ShapeNames& names);

 private:
  struct Place;
  Result<void> add_node(std::size_t node, ShapeNames& names);
  Result<RawPiece> primitive(const Json& mesh, const Json& entry, const Place& place,
                             ShapeNames& names);
  Result<void> add_attributes(const Json& attributes, const Place& place, RawPiece& piece,
                              std::vector<Affine>& maps);
  Result<std::vector<Affine>> skin_maps(const Json& attributes, const Skin& skin,
                                        std::size_t vertices, RawPiece& piece);
  Result<void> add_morphs(const Json& entry, const std::vector<Affine>& maps, RawPiece& piece,
                          ShapeNames& names);

  const File& file_;
  const std::vector<Node>& nodes_;
  std::vector<float> shares_;
  std::vector<bool> jaw_;  // nodes that it carries
  Paints& paints_;
  TargetNames expressions_;
  std::vector<RawPiece> pieces_;
  std::uint32_t next_number_ = 0;  // of the node at hand
};

}  // namespace animeme::gltf
