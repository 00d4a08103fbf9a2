#include "tools/view/gltf/detail/primitive.h"

#include <algorithm>

#include "tools/view/gltf/detail/extensions.h"
#include "tools/view/gltf/detail/target_names.h"
#include "tools/view/gltf/detail/words.h"

namespace animeme::gltf {
namespace {

using head::Vec3;
using head::Vec3d;

constexpr std::size_t kTriangles = 4;
constexpr std::size_t kTriangleStrip = 5;
constexpr std::size_t kTriangleFan = 6;

// Without those that have no area because two corners are one. Error: syntax (an index beyond the
// vertices).
Result<std::vector<head::Triangle>> triangles_of(const std::vector<std::uint32_t>& indices,
                                                 std::size_t vertices, std::size_t mode) {
  std::vector<head::Triangle> triangles;
  for (const std::uint32_t index : indices) {
    if (index >= vertices) {
      return make_error(Code::syntax,
                        "a triangle has a vertex that does not exist: export the file again");
    }
  }
  const std::size_t step = mode == kTriangles ? 3 : 1;
  for (std::size_t i = 0; i + 2 < indices.size(); i += step) {
    head::Triangle t = {indices[i], indices[i + 1], indices[i + 2]};
    if (mode == kTriangleStrip && i % 2 == 1) std::swap(t[1], t[2]);
    if (mode == kTriangleFan) t = {indices[0], indices[i + 1], indices[i + 2]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

std::vector<Uv> uvs_of(const std::vector<float>& values) {
  std::vector<Uv> uvs;
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) uvs.push_back({values[i], values[i + 1]});
  return uvs;
}

// Level of detail, as "head_LOD1" has it; -1: none.
int level_of(const Node& node) {
  const std::string name = joined(words_of(node.name));
  const std::size_t at = name.find("lod");
  if (at == std::string::npos || at + 3 >= name.size()) return -1;
  const char digit = name[at + 3];
  return digit >= '0' && digit <= '9' ? digit - '0' : -1;
}

// A mirrored mesh shows its back.
bool mirrors(const Affine& map) {
  const Vec3d x = map.direction({1, 0, 0}), y = map.direction({0, 1, 0});
  return head::dot(head::cross(x, y), map.direction({0, 0, 1})) < 0;
}

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

// Where a mesh is put, and how far it turns with the head.
struct MeshReader::Place {
  std::size_t index = 0;
  const Node* node = nullptr;
  const Skin* skin = nullptr;
  std::optional<float> share;  ///< of a mesh that hangs on a bone
  bool on_jaw = false;         ///< likewise
};

std::size_t ShapeNames::index_of(const std::string& name) {
  const auto [place, is_new] = numbers_.try_emplace(name, names_.size());
  if (is_new) names_.push_back(name);
  return place->second;
}

Result<std::vector<RawPiece>> MeshReader::read(ShapeNames& names) {
  const bool has_levels = std::any_of(nodes_.begin(), nodes_.end(), [](const Node& node) {
    return node.mesh && level_of(node) == 0;
  });
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].shown || !nodes_[i].mesh) continue;
    if (has_levels && level_of(nodes_[i]) > 0) continue;
    if (auto done = add_node(i, names); !done) return done.error();
  }
  return std::move(pieces_);
}

Result<void> MeshReader::add_node(std::size_t index, ShapeNames& names) {
  const Node& node = nodes_[index];
  const Json& mesh = file_.entry("meshes", *node.mesh);
  if (!mesh.is_object()) {
    return make_error(Code::syntax, "node " + std::to_string(index) +
                                        " has a mesh that does not exist: export the file again");
  }
  std::optional<Skin> skin;
  if (node.skin) {
    auto read = read_skin(file_, nodes_, *node.skin);
    if (!read) return read.error();
    skin = std::move(*read);
  }
  next_number_ = 0;
  Place place{index, &node, skin ? &*skin : nullptr, {}};
  if (!skin && !shares_.empty() && shares_[index] > 0) place.share = shares_[index];
  place.on_jaw = !skin && jaw_[index];
  for (const Json& entry : list(mesh, "primitives")) {
    const std::size_t mode = whole_or(member(entry, "mode"), kTriangles);
    if (mode < kTriangles || mode > kTriangleFan) continue;  // points and lines
    auto piece = primitive(mesh, entry, place, names);
    if (!piece) return piece.error();
    if (!piece->triangles.empty()) pieces_.push_back(std::move(*piece));
  }
  return {};
}

Result<RawPiece> MeshReader::primitive(const Json& mesh, const Json& entry, const Place& place,
                                       ShapeNames& names) {
  RawPiece piece;
  piece.node = place.index;
  piece.on_jaw = place.on_jaw;
  piece.name = place.node->name;
  const std::string mesh_name = text_or(member(mesh, "name"));
  // Both may tell which part it is: "Anna", "Teeth".
  if (piece.name.empty()) {
    piece.name = mesh_name;
  } else if (!mesh_name.empty() && mesh_name != piece.name) {
    piece.name += " " + mesh_name;
  }
  piece.paint = &paints_.of(whole(member(entry, "material")));
  const Json& attributes = member(entry, "attributes");
  if (is_compressed(entry) && !member(attributes, "POSITION").is_null() &&
      member(file_.entry("accessors", whole_or(member(attributes, "POSITION"), 0)), "bufferView")
          .is_null()) {
    return compressed_error("KHR_draco_mesh_compression");
  }
  std::vector<Affine> maps;
  if (auto done = add_attributes(attributes, place, piece, maps); !done) return done.error();
  std::vector<std::uint32_t> indices;
  const bool indexed = !member(entry, "indices").is_null();
  if (indexed) {
    const std::size_t accessor = whole_or(member(entry, "indices"), ~std::size_t(0));
    const auto count = count_of(file_, accessor);
    if (!count) return count.error();
    const bool list_of_three = whole_or(member(entry, "mode"), kTriangles) == kTriangles;
    if (auto fine = file_.budget->take_triangles(list_of_three ? *count / 3 : *count); !fine) {
      return fine.error();
    }
    auto read = read_wholes(file_, accessor, 1, *count);
    if (!read) return read.error();
    indices = std::move(*read);
  } else {
    for (std::uint32_t v = 0; v < piece.positions.size(); ++v) indices.push_back(v);
  }
  auto triangles =
      triangles_of(indices, piece.positions.size(), whole_or(member(entry, "mode"), kTriangles));
  if (!triangles) return triangles.error();
  piece.triangles = std::move(*triangles);
  piece.numbers.assign(piece.positions.size(), kNewVertex);
  for (const head::Triangle& t : piece.triangles) {
    for (const std::uint32_t v : t) piece.numbers[v] = 0;
  }
  for (std::uint32_t& number : piece.numbers) {
    if (number == 0) number = next_number_++;
  }
  if (!maps.empty() && mirrors(maps[0])) {
    for (head::Triangle& t : piece.triangles) std::swap(t[1], t[2]);
  }
  if (auto done = add_morphs(entry, maps, piece, names); !done) return done.error();
  return piece;
}

Result<void> MeshReader::add_attributes(const Json& attributes, const Place& place, RawPiece& piece,
                                        std::vector<Affine>& maps) {
  const auto accessor = whole(member(attributes, "POSITION"));
  const auto vertices = accessor ? count_of(file_, *accessor) : Result<std::size_t>(0);
  if (!vertices) return vertices.error();
  const std::size_t count = *vertices;
  if (auto fine = file_.budget->take_vertices(count); !fine || !accessor) return fine;
  auto places = read_floats(file_, *accessor, 3, count);
  if (!places) return places.error();
  if (place.skin != nullptr && !member(attributes, "JOINTS_0").is_null()) {
    auto skinned = skin_maps(attributes, *place.skin, count, piece);
    if (!skinned) return skinned.error();
    maps = std::move(*skinned);
  } else {
    maps = {place.node->world};
    if (place.share) piece.neck_weights.assign(count, *place.share);
  }
  for (std::size_t v = 0; v < count; ++v) {
    const float* p = places->data() + 3 * v;
    const Affine& map = maps[std::min(v, maps.size() - 1)];
    piece.positions.push_back(Vec3(map.place({double(p[0]), double(p[1]), double(p[2])})));
    if (!is_finite(piece.positions.back())) {
      return make_error(Code::syntax, "a vertex position is not finite: export the file again");
    }
  }
  const std::string uv_set = "TEXCOORD_" + std::to_string(piece.paint->uv_set);
  if (const auto uv = whole(member(attributes, uv_set.c_str())); uv && piece.paint->textured) {
    auto read = read_floats(file_, *uv, 2, count);
    if (!read) return read.error();
    piece.uvs = uvs_of(*read);
    piece.uvs.resize(count);
  }
  if (const auto normal = whole(member(attributes, "NORMAL"))) {
    auto read = read_floats(file_, *normal, 3, count);
    if (!read) return read.error();
    for (std::size_t v = 0; v < std::min(count, read->size() / 3); ++v) {
      const float* n = read->data() + 3 * v;
      const Vec3d turned =
          maps[std::min(v, maps.size() - 1)].direction({double(n[0]), double(n[1]), double(n[2])});
      const Vec3 unit(head::normalised(turned));
      piece.normals.push_back(is_finite(unit) ? unit : Vec3{});
    }
  }
  const auto colour = whole(member(attributes, "COLOR_0"));
  if (!colour) return {};
  const bool has_alpha = text_or(member(file_.entry("accessors", *colour), "type")) == "VEC4";
  const std::size_t parts = has_alpha ? 4 : 3;
  auto read = read_floats(file_, *colour, parts, count);
  if (!read) return read.error();
  piece.colours.resize(count);
  for (std::size_t v = 0; v < std::min(count, read->size() / parts); ++v) {
    const float* c = read->data() + v * parts;
    piece.colours[v] = {{c[0], c[1], c[2]}, has_alpha ? c[3] : 1};
  }
  return {};
}

Result<std::vector<Affine>> MeshReader::skin_maps(const Json& attributes, const Skin& skin,
                                                  std::size_t vertices, RawPiece& piece) {
  std::vector<Affine> maps(vertices);
  for (Affine& map : maps) map.rows = {};
  std::vector<double> sums(vertices, 0);
  std::vector<double> turns(vertices, 0);
  for (int set = 0; set < 8; ++set) {
    const std::string number = std::to_string(set);
    const auto joints = whole(member(attributes, ("JOINTS_" + number).c_str()));
    const auto weights = whole(member(attributes, ("WEIGHTS_" + number).c_str()));
    if (!joints || !weights) break;
    auto numbers = read_wholes(file_, *joints, 4, vertices);
    if (!numbers) return numbers.error();
    auto shares = read_floats(file_, *weights, 4, vertices);
    if (!shares) return shares.error();
    for (std::size_t i = 0; i < std::min({numbers->size(), shares->size(), vertices * 4}); ++i) {
      const double weight = double((*shares)[i]);
      const std::size_t joint = (*numbers)[i];
      if (!(weight > 0)) continue;
      if (joint >= skin.joints.size()) {
        return make_error(Code::syntax,
                          "a vertex hangs on a joint that does not exist: export the file again");
      }
      add_scaled(maps[i / 4], skin.bind[joint], weight);
      sums[i / 4] += weight;
      piece.on_jaw = piece.on_jaw || (jaw_[skin.joints[joint]] && weight > 0.02);
      if (!shares_.empty()) turns[i / 4] += weight * double(shares_[skin.joints[joint]]);
    }
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    if (sums[v] > 0) {
      for (auto& row : maps[v].rows) {
        for (double& value : row) value /= sums[v];
      }
    } else {
      maps[v] = skin.bind[0];
    }
    if (!shares_.empty()) {
      piece.neck_weights.push_back(sums[v] > 0 ? float(turns[v] / sums[v]) : 0);
    }
  }
  return maps;
}

Result<void> MeshReader::add_morphs(const Json& entry, const std::vector<Affine>& maps,
                                    RawPiece& piece, ShapeNames& names) {
  const std::span<const Json> targets = list(entry, "targets");
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const auto accessor = whole(member(targets[t], "POSITION"));
    if (!accessor) continue;
    auto moves = read_moves(file_, *accessor, piece.positions.size());
    if (!moves) return moves.error();
    if (moves->vertices.empty()) continue;
    for (std::size_t i = 0; i < moves->vertices.size(); ++i) {
      const Affine& map = maps[std::min<std::size_t>(moves->vertices[i], maps.size() - 1)];
      Vec3& delta = moves->deltas[i];
      delta = Vec3(map.direction(Vec3d(delta)));
      if (!is_finite(delta)) {
        return make_error(Code::syntax, "a shape moves beyond all numbers: export the file again");
      }
    }
    piece.morphs.push_back(
        {names.index_of(target_name(file_, expressions_, *nodes_[piece.node].mesh, entry, t)),
         std::move(*moves)});
  }
  std::stable_sort(piece.morphs.begin(), piece.morphs.end(),
                   [](const PieceMorph& a, const PieceMorph& b) { return a.shape < b.shape; });
  return {};
}

}  // namespace animeme::gltf
