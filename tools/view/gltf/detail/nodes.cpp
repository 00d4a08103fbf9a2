#include "tools/view/gltf/detail/nodes.h"

#include "tools/view/gltf/detail/accessor.h"

namespace animeme::gltf {
namespace {

using head::Vec3d;

constexpr std::size_t kMostNodes = 100'000;

Error bad_node(std::size_t node, const std::string& what) {
  return make_error(Code::syntax,
                    "node " + std::to_string(node) + " " + what + ": export the file again");
}

Affine local_of(const Json& entry) {
  if (const auto matrix = numbers(member(entry, "matrix"), 16)) return affine_of(matrix->data());
  const auto t = numbers(member(entry, "translation"), 3);
  const auto r = numbers(member(entry, "rotation"), 4);
  const auto s = numbers(member(entry, "scale"), 3);
  std::array<double, 4> q = {0, 0, 0, 1};
  if (r) {
    const double length =
        std::sqrt((*r)[0] * (*r)[0] + (*r)[1] * (*r)[1] + (*r)[2] * (*r)[2] + (*r)[3] * (*r)[3]);
    if (length > 0 && std::isfinite(length)) {
      for (std::size_t i = 0; i < 4; ++i) q[i] = (*r)[i] / length;
    }
  }
  const auto [x, y, z, w] = q;
  Affine map;
  map.rows = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      map.rows[row][column] *= s ? (*s)[column] : 1;
    }
    map.rows[row][3] = t ? (*t)[row] : 0;
  }
  return map;
}

Result<void> set_parents(const File& file, std::vector<Node>& nodes) {
  const std::span<const Json> entries = list(file.root, "nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const Json& child : list(entries[i], "children")) {
      const std::size_t index = whole_or(child, kNoNode);
      if (index >= nodes.size()) return bad_node(i, "has a child that does not exist");
      if (nodes[index].parent != kNoNode) return bad_node(index, "has two parents");
      nodes[index].parent = i;
    }
  }
  return {};
}

// Parents before their children. Nodes in a circle are in no order: they are missing.
std::vector<std::size_t> order_of(const File& file, const std::vector<Node>& nodes) {
  const std::span<const Json> entries = list(file.root, "nodes");
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent == kNoNode) order.push_back(i);
  }
  for (std::size_t at = 0; at < order.size(); ++at) {
    for (const Json& child : list(entries[order[at]], "children")) order.push_back(*whole(child));
  }
  return order;
}

void mark_shown(const File& file, const std::vector<std::size_t>& order, std::vector<Node>& nodes) {
  bool any = false;
  for (const Json& scene : list(file.root, "scenes")) {
    for (const Json& root : list(scene, "nodes")) {
      const std::size_t index = whole_or(root, kNoNode);
      if (index < nodes.size()) any = nodes[index].shown = true;
    }
  }
  for (const std::size_t i : order) {
    Node& node = nodes[i];
    node.shown = node.shown || !any || (node.parent != kNoNode && nodes[node.parent].shown);
  }
}

}  // namespace

Vec3d Affine::direction(Vec3d d) const {
  const auto along = [&](const std::array<double, 4>& row) {
    return row[0] * d.x + row[1] * d.y + row[2] * d.z;
  };
  return {along(rows[0]), along(rows[1]), along(rows[2])};
}

Vec3d Affine::place(Vec3d p) const { return direction(p) + origin(); }

Affine operator*(const Affine& outer, const Affine& inner) {
  Affine out;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = column == 3 ? outer.rows[row][3] : 0;
      for (std::size_t k = 0; k < 3; ++k) sum += outer.rows[row][k] * inner.rows[k][column];
      out.rows[row][column] = sum;
    }
  }
  return out;
}

void add_scaled(Affine& sum, const Affine& map, double weight) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      sum.rows[row][column] += map.rows[row][column] * weight;
    }
  }
}

Result<std::vector<Node>> read_nodes(const File& file) {
  const std::span<const Json> entries = list(file.root, "nodes");
  if (entries.size() > kMostNodes) {
    return make_error(Code::out_of_range,
                      "the file has more than " + std::to_string(kMostNodes) +
                          " nodes, the most that are read: leave out what is not the head");
  }
  std::vector<Node> nodes(entries.size());
  if (auto done = set_parents(file, nodes); !done) return done.error();
  const std::vector<std::size_t> order = order_of(file, nodes);
  if (order.size() != nodes.size()) {
    return make_error(Code::syntax, "nodes are their own ancestors: export the file again");
  }
  for (const std::size_t i : order) {
    Node& node = nodes[i];
    node.name = text_or(member(entries[i], "name"));
    node.mesh = whole(member(entries[i], "mesh"));
    node.skin = whole(member(entries[i], "skin"));
    node.world = local_of(entries[i]);
    if (node.parent != kNoNode) node.world = nodes[node.parent].world * node.world;
  }
  mark_shown(file, order, nodes);
  return nodes;
}

std::vector<bool> nodes_below(const std::vector<Node>& nodes, std::size_t ancestor) {
  enum : char { unknown, no, yes };
  std::vector<char> marks(nodes.size(), unknown);
  if (ancestor < nodes.size()) marks[ancestor] = yes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::size_t top = i;
    while (marks[top] == unknown && nodes[top].parent != kNoNode) top = nodes[top].parent;
    const char mark = marks[top] == yes ? yes : no;
    for (std::size_t n = i; marks[n] == unknown; n = nodes[n].parent) {
      marks[n] = mark;
      if (nodes[n].parent == kNoNode) break;
    }
  }
  std::vector<bool> below;
  for (const char mark : marks) below.push_back(mark == yes);
  return below;
}

Result<Skin> read_skin(const File& file, const std::vector<Node>& nodes, std::size_t skin) {
  const Json& entry = file.entry("skins", skin);
  const std::span<const Json> joints = list(entry, "joints");
  // Several nodes may have the same skin.
  if (auto fine = file.budget->take_elements(joints.size()); !fine) return fine.error();
  Skin out;
  for (const Json& joint : joints) {
    out.joints.push_back(whole_or(joint, kNoNode));
    if (out.joints.back() >= nodes.size()) {
      return make_error(Code::syntax,
                        "skin " + std::to_string(skin) +
                            " has a joint that does not exist: export the file again");
    }
  }
  if (out.joints.empty()) {
    return make_error(Code::syntax,
                      "skin " + std::to_string(skin) + " has no joints: export the file again");
  }
  std::vector<float> inverse;
  if (const auto accessor = whole(member(entry, "inverseBindMatrices"))) {
    auto read = read_floats(file, *accessor, 16, out.joints.size());
    if (!read) return read.error();
    inverse = std::move(*read);
  }
  for (std::size_t i = 0; i < out.joints.size(); ++i) {
    const Affine& joint = nodes[out.joints[i]].world;
    const bool given = inverse.size() >= (i + 1) * 16;
    out.bind.push_back(given ? joint * affine_of(inverse.data() + i * 16) : joint);
  }
  return out;
}

}  // namespace animeme::gltf
