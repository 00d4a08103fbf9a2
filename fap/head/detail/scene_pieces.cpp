#include <cmath>
#include <set>

#include "fap/head/detail/scene.h"
#include "fap/head/srgb.h"

namespace animeme::head::detail {
namespace {

constexpr std::size_t kMostVertices = 500'000;
constexpr std::size_t kMostNodes = 200'000;  // reached, each use counts
constexpr Vec3 kPlain{0.8f, 0.8f, 0.8f};     // default of Material, sRGB

// The row vectors of a rotation about an axis.
Transform rotation(const std::array<double, 4>& r) {
  const double size = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  if (size <= 0) return {};
  const double x = r[0] / size;
  const double y = r[1] / size;
  const double z = r[2] / size;
  const double c = std::cos(r[3]);
  const double s = std::sin(r[3]);
  const double t = 1 - c;
  const auto row = [](double a, double b, double d) { return Vec3{float(a), float(b), float(d)}; };
  return {row(t * x * x + c, t * x * y - s * z, t * x * z + s * y),
          row(t * x * y + s * z, t * y * y + c, t * y * z - s * x),
          row(t * x * z - s * y, t * y * z + s * x, t * z * z + c),
          {}};
}

Transform shift_by(Vec3 by) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by}; }

bool mirrors(const Transform& t) { return dot(cross(t.row_x, t.row_y), t.row_z) < 0; }

Error outside(Position where, std::string_view what, std::int64_t index, std::size_t count) {
  return {Code::out_of_range,
          std::string(what) + " " + std::to_string(index) + " is named, but there are " +
              std::to_string(count) + ", counted from 0",
          std::move(where)};
}

// What the corners of the polygons of a set say, corner by corner.
class FaceReader {
 public:
  /// With urls in `picture` its corners are read, too.
  FaceReader(const SceneNode& faces, Mesh& mesh, ScenePicture& picture)
      : faces_(faces), mesh_(mesh), picture_(picture) {}

  Result<void> read(bool flipped) {
    colours_ = faces_.child("Color");
    if (!picture_.urls.empty()) places_ = faces_.child("TextureCoordinate");
    if (!picture_.urls.empty() && places_ == nullptr) picture_.problem = "has no texCoord";
    sums_.resize(mesh_.positions.size());
    counts_.resize(mesh_.positions.size());
    for (std::size_t i = 0; i <= faces_.coord_index.size(); ++i) {
      const bool end = i == faces_.coord_index.size();
      if (end || faces_.coord_index[i] < 0) {
        if (auto done = add_polygon(flipped); !done) return done;
        continue;
      }
      const std::int32_t vertex = faces_.coord_index[i];
      if (std::size_t(vertex) >= mesh_.positions.size()) {
        return outside(faces_.coord_where, "vertex", vertex, mesh_.positions.size());
      }
      corners_.push_back({std::uint32_t(vertex), i});
    }
    return {};
  }

  void colour(Vec3 otherwise) {
    for (std::size_t v = 0; v < sums_.size(); ++v) {
      const Vec3 c = counts_[v] > 0 ? sums_[v] * (1 / float(counts_[v])) : otherwise;
      const auto bounded = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
      mesh_.colours.push_back(linear_of_srgb(Vec3{bounded(c.x), bounded(c.y), bounded(c.z)}));
    }
  }

 private:
  struct Corner {
    std::uint32_t vertex;
    std::size_t index;  // in coord_index
  };

  // Where in the list of colours that of a corner is.
  std::int64_t colour_of(const Corner& corner) const {
    const std::vector<std::int32_t>& index = faces_.colour_index;
    if (faces_.colour_per_vertex) {
      if (index.empty()) return corner.vertex;
      return corner.index < index.size() ? index[corner.index] : -1;
    }
    if (index.empty()) return std::int64_t(polygon_);
    return polygon_ < index.size() ? index[polygon_] : -1;
  }

  void add_texture_places() {
    if (places_ == nullptr) return;
    const std::vector<std::int32_t>& index = faces_.texture_index;
    for (const Corner& corner : corners_) {
      const std::int64_t place = index.empty()                 ? std::int64_t(corner.vertex)
                                 : corner.index < index.size() ? index[corner.index]
                                                               : -1;
      if (place < 0 || std::size_t(place) >= places_->texture_places.size()) {
        picture_.problem = "names texture coordinate " + std::to_string(place) +
                           ", but there are " + std::to_string(places_->texture_places.size()) +
                           ", counted from 0";
        places_ = nullptr;
        picture_.corners.clear();
        return;
      }
      picture_.corners.push_back({corner.vertex, places_->texture_places[std::size_t(place)]});
    }
  }

  Result<void> add_polygon(bool flipped) {
    if (corners_.empty()) return {};  // -1 twice, or at the end
    for (std::size_t k = 2; k < corners_.size(); ++k) {
      Triangle t{corners_[0].vertex, corners_[k - 1].vertex, corners_[k].vertex};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      if (flipped) std::swap(t[1], t[2]);
      mesh_.triangles.push_back(t);
    }
    add_texture_places();
    for (const Corner& corner : corners_) {
      if (colours_ == nullptr || colours_->values.empty()) break;
      const std::int64_t c = colour_of(corner);
      if (c < 0 || std::size_t(c) >= colours_->values.size()) {
        const bool indexed = !faces_.colour_index.empty();
        return outside(indexed ? faces_.colour_where : colours_->where, "colour", c,
                       colours_->values.size());
      }
      sums_[corner.vertex] += colours_->values[std::size_t(c)];
      ++counts_[corner.vertex];
    }
    corners_.clear();
    ++polygon_;
    return {};
  }

  const SceneNode& faces_;
  Mesh& mesh_;
  ScenePicture& picture_;
  const SceneNode* colours_ = nullptr;
  const SceneNode* places_ = nullptr;  // of the texture, while they are good
  std::vector<Vec3> sums_;
  std::vector<int> counts_;
  std::vector<Corner> corners_;
  std::size_t polygon_ = 0;
};

class Flattener {
 public:
  Result<void> visit(const SceneNode& node, const Transform& place) {
    if (++nodes_ > kMostNodes) {
      return Error{Code::out_of_range,
                   "the scene has more than 200 000 nodes, each USE counted; write it without USE",
                   node.where};
    }
    if (node.type == "Shape") return add(node, place);
    above_.push_back(&node);
    const Transform inner =
        node.type == "Transform" ? compose(place, placement(node)) : Transform(place);
    for (const SceneNodePtr& child : node.children) {
      if (auto done = visit(*child, inner); !done) return done;
    }
    above_.pop_back();
    return {};
  }

  std::vector<ScenePiece> take() { return std::move(pieces_); }

 private:
  std::string name_of(const SceneNode& shape, const SceneNode& faces) const {
    if (!shape.name.empty()) return shape.name;
    if (!faces.name.empty()) return faces.name;
    for (std::size_t i = above_.size(); i-- > 0;) {
      if (!above_[i]->name.empty()) return above_[i]->name;
    }
    return {};
  }

  Result<void> add(const SceneNode& shape, const Transform& place) {
    const SceneNode* faces = shape.child("IndexedFaceSet");
    if (faces == nullptr) return {};
    const SceneNode* points = faces->child("Coordinate");
    const std::size_t count = points == nullptr ? 0 : points->values.size();
    vertices_ += count;
    if (vertices_ > kMostVertices) {
      return Error{Code::out_of_range, "the scene has more than 500000 vertices; reduce its meshes",
                   faces->where};
    }
    ScenePiece out;
    out.faces = faces;
    out.above = above_;
    out.place = place;
    out.geometry_name = faces->name;
    out.first_use = seen_.insert(faces).second;
    out.piece.name = name_of(shape, *faces);
    Mesh& mesh = out.piece.mesh;
    for (std::size_t i = 0; i < count; ++i) mesh.positions.push_back(place(points->values[i]));
    const SceneNode* appearance = shape.child("Appearance");
    const SceneNode* texture = appearance == nullptr ? nullptr : appearance->child("ImageTexture");
    if (texture != nullptr) out.picture.urls = texture->urls;
    FaceReader reader(*faces, mesh, out.picture);
    if (auto done = reader.read(mirrors(place) == faces->counterclockwise); !done) return done;
    const SceneNode* material = appearance == nullptr ? nullptr : appearance->child("Material");
    if (material != nullptr) out.piece.material = material->name;
    const bool coloured = faces->child("Color") != nullptr;
    if (coloured || material != nullptr) {
      reader.colour(material != nullptr ? material->diffuse.value_or(kPlain) : kPlain);
    }
    pieces_.push_back(std::move(out));
    return {};
  }

  std::vector<ScenePiece> pieces_;
  std::vector<const SceneNode*> above_;
  std::set<const SceneNode*> seen_;
  std::size_t vertices_ = 0;
  std::size_t nodes_ = 0;
};

}  // namespace

// Source: VRML97, Transform: P' = T C R SR S -SR -C P.
Transform placement(const SceneNode& t) {
  std::array<double, 4> back = t.scale_orientation;
  back[3] = -back[3];
  const Transform scaling{{t.scale.x, 0, 0}, {0, t.scale.y, 0}, {0, 0, t.scale.z}, {}};
  Transform m = compose(rotation(back), shift_by(t.centre * -1.0f));
  m = compose(rotation(t.scale_orientation), compose(scaling, m));
  return compose(shift_by(t.translation + t.centre), compose(rotation(t.rotation), m));
}

Result<std::vector<ScenePiece>> scene_pieces(std::span<const SceneNodePtr> roots) {
  Flattener flattener;
  for (const SceneNodePtr& root : roots) {
    if (auto done = flattener.visit(*root, {}); !done) return done.error();
  }
  return flattener.take();
}

}  // namespace animeme::head::detail
