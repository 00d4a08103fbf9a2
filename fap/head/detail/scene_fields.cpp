#include <cmath>

#include "fap/head/detail/scene.h"

namespace animeme::head::detail {
namespace {

Error at(const SceneValue& value, Code code, std::string message) {
  return {code, std::move(message), value.where};
}

std::string of(const SceneNode& node, std::string_view field) {
  return "field " + std::string(field) + " of " + node.type;
}

Result<void> set_vectors(const SceneNode& node, std::string_view field, const SceneValue& value,
                         std::vector<Vec3>& out) {
  if (value.numbers.size() % 3 != 0) {
    return at(value, Code::syntax,
              of(node, field) + " has " + std::to_string(value.numbers.size()) +
                  " numbers; they come in threes");
  }
  out.clear();
  out.reserve(value.numbers.size() / 3);
  for (std::size_t i = 0; i < value.numbers.size(); i += 3) {
    const double* n = &value.numbers[i];
    const Vec3 v{float(n[0]), float(n[1]), float(n[2])};
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
      return at(value, Code::out_of_range, of(node, field) + " has a number that is not finite");
    }
    out.push_back(v);
  }
  return {};
}

Result<void> set_vector(const SceneNode& node, std::string_view field, const SceneValue& value,
                        Vec3& out) {
  std::vector<Vec3> vectors;
  if (auto done = set_vectors(node, field, value, vectors); !done) return done;
  if (vectors.size() != 1) {
    return at(value, Code::syntax, of(node, field) + " needs three numbers");
  }
  out = vectors.front();
  return {};
}

Result<void> set_rotation(const SceneNode& node, std::string_view field, const SceneValue& value,
                          std::array<double, 4>& out) {
  if (value.numbers.size() != 4) {
    return at(value, Code::syntax, of(node, field) + " needs four numbers: axis and angle");
  }
  for (const double n : value.numbers) {
    if (!std::isfinite(n) || std::abs(n) > 1e6) {
      return at(value, Code::out_of_range, of(node, field) + " is no rotation");
    }
  }
  std::copy(value.numbers.begin(), value.numbers.end(), out.begin());
  return {};
}

Result<void> set_indices(const SceneNode& node, std::string_view field, const SceneValue& value,
                         std::vector<std::int32_t>& out, Position& where) {
  out.clear();
  out.reserve(value.numbers.size());
  where = value.where;
  for (const double n : value.numbers) {
    if (!(n >= -1e9 && n <= 1e9) || n != std::floor(n)) {
      return at(value, Code::syntax, of(node, field) + " has an invalid index");
    }
    out.push_back(std::int32_t(n));
  }
  return {};
}

Result<void> set_texture_places(const SceneNode& node, std::string_view field,
                                const SceneValue& value, std::vector<TexturePlace>& out) {
  if (value.numbers.size() % 2 != 0) {
    return at(value, Code::syntax,
              of(node, field) +
                  " has an odd number of numbers; they come in "
                  "twos");
  }
  out.clear();
  for (std::size_t i = 0; i < value.numbers.size(); i += 2) {
    out.push_back({float(value.numbers[i]), float(value.numbers[i + 1])});
    if (!std::isfinite(out.back().u) || !std::isfinite(out.back().v)) {
      return at(value, Code::out_of_range, of(node, field) + " has a number that is not finite");
    }
  }
  return {};
}

bool truth(const SceneValue& value, bool otherwise) {
  if (value.words.empty()) return otherwise;
  return value.words.front() == "TRUE" || value.words.front() == "true";
}

Result<void> set_transform_field(SceneNode& node, std::string_view field, const SceneValue& value) {
  if (field == "translation") return set_vector(node, field, value, node.translation);
  if (field == "center") return set_vector(node, field, value, node.centre);
  if (field == "scale") return set_vector(node, field, value, node.scale);
  if (field == "rotation") return set_rotation(node, field, value, node.rotation);
  if (field == "scaleOrientation") return set_rotation(node, field, value, node.scale_orientation);
  return {};
}

Result<void> set_faces_field(SceneNode& node, std::string_view field, const SceneValue& value) {
  if (field == "coordIndex") {
    return set_indices(node, field, value, node.coord_index, node.coord_where);
  }
  if (field == "colorIndex") {
    return set_indices(node, field, value, node.colour_index, node.colour_where);
  }
  if (field == "texCoordIndex") {
    Position unused;
    return set_indices(node, field, value, node.texture_index, unused);
  }
  if (field == "colorPerVertex") node.colour_per_vertex = truth(value, true);
  if (field == "ccw") node.counterclockwise = truth(value, true);
  return {};
}

}  // namespace

const SceneNode* SceneNode::child(std::string_view child_type) const {
  for (const SceneNodePtr& node : children) {
    if (node->type == child_type) return node.get();
  }
  return nullptr;
}

Result<void> set_field(SceneNode& node, std::string_view field, SceneValue value) {
  if (!value.nodes.empty()) {
    for (SceneNodePtr& child : value.nodes) {
      if (!child) continue;
      node.height = std::max(node.height, child->height + 1);
      if (node.height > kDeepestNode) {
        return at(value, Code::out_of_range,
                  "nodes are nested more than " + std::to_string(kDeepestNode) + " levels");
      }
      node.children.push_back(std::move(child));
    }
    return {};
  }
  if (node.type == "Transform") return set_transform_field(node, field, value);
  if (node.type == "IndexedFaceSet") return set_faces_field(node, field, value);
  if ((node.type == "Coordinate" && field == "point") ||
      (node.type == "Color" && field == "color")) {
    return set_vectors(node, field, value, node.values);
  }
  if (node.type == "TextureCoordinate" && field == "point") {
    return set_texture_places(node, field, value, node.texture_places);
  }
  if (node.type == "ImageTexture" && field == "url") node.urls = std::move(value.words);
  if (node.type == "Material" && field == "diffuseColor") {
    Vec3 colour;
    if (auto done = set_vector(node, field, value, colour); !done) return done;
    node.diffuse = colour;
  }
  return {};
}

}  // namespace animeme::head::detail
