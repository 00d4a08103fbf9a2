// Where things are: the tree of nodes, and skins.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fap/head/vector.h"
#include "tools/view/gltf/detail/file.h"

namespace animeme::gltf {

/// Rows of an affine map: rotation, scale and shear, then the shift.
struct Affine {
  std::array<std::array<double, 4>, 3> rows = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  head::Vec3d place(head::Vec3d p) const;
  head::Vec3d direction(head::Vec3d d) const;
  head::Vec3d origin() const { return {rows[0][3], rows[1][3], rows[2][3]}; }
};

/// First `inner`, then `outer`.
Affine operator*(const Affine& outer, const Affine& inner);
/// Sum of maps: how skins blend.
void add_scaled(Affine& sum, const Affine& map, double weight);

/// The map of a matrix as glTF writes them: 16 numbers, column by column.
template <class Number>
Affine affine_of(const Number* columns) {
  Affine map;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      map.rows[row][column] = double(columns[column * 4 + row]);
    }
  }
  return map;
}

inline constexpr std::size_t kNoNode = ~std::size_t(0);

struct Node {
  std::string name;
  std::size_t parent = kNoNode;
  Affine world;
  bool shown = false;  ///< in a scene; if the file has none, all are
  std::optional<std::size_t> mesh;
  std::optional<std::size_t> skin;
};

/// All nodes by number, at rest. Error: syntax (a child that is none, two parents, a circle).
Result<std::vector<Node>> read_nodes(const File& file);

/// For each node: true if it is `ancestor` or lies below it. None is, if that is kNoNode.
std::vector<bool> nodes_below(const std::vector<Node>& nodes, std::size_t ancestor);

struct Skin {
  std::vector<std::size_t> joints;  ///< nodes
  std::vector<Affine> bind;         ///< of each joint: from the mesh to the bind pose in the world
};

/// Error: syntax.
Result<Skin> read_skin(const File& file, const std::vector<Node>& nodes, std::size_t skin);

}  // namespace animeme::gltf
