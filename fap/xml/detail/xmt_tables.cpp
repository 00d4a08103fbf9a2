#include "fap/xml/detail/xmt_tables.h"

#include <algorithm>

#include "fap/xml/detail/moves.h"
#include "fap/xml/detail/numbers.h"

namespace animeme::head::detail {
namespace {

constexpr std::size_t kMostMoves = 4'000'000;

// A FaceDefMesh as numbers. Displacements come vertex by vertex, for each its intervals.
struct MeshTable {
  std::vector<double> borders;
  std::vector<std::uint32_t> vertices;
  std::vector<Vec3> displacements;

  std::size_t intervals() const { return borders.size() < 3 ? 1 : borders.size() - 1; }
};

Result<MeshTable> read_mesh_table(const XmlElement& element) {
  MeshTable table;
  auto borders = numbers_of(element, "intervalBorders");
  if (!borders) return borders.error();
  table.borders = std::move(*borders);
  for (std::size_t i = 1; i < table.borders.size(); ++i) {
    if (!(table.borders[i - 1] < table.borders[i])) {
      return element.error(Code::syntax, "intervalBorders of <FaceDefMesh> do not ascend");
    }
  }
  const auto vertices = numbers_of(element, "coordIndex");
  if (!vertices) return vertices.error();
  for (const double v : *vertices) {
    if (v < 0 || v > 1e9 || v != std::floor(v)) {
      return element.error(Code::syntax, "coordIndex of <FaceDefMesh> has an invalid vertex index");
    }
    table.vertices.push_back(std::uint32_t(v));
  }
  const auto moves = numbers_of(element, "displacements");
  if (!moves) return moves.error();
  const std::size_t wanted = 3 * table.intervals() * table.vertices.size();
  if (moves->size() != wanted) {
    return element.error(Code::syntax, "displacements of <FaceDefMesh> have " +
                                           std::to_string(moves->size()) + " numbers; " +
                                           std::to_string(table.vertices.size()) +
                                           " vertices and " + std::to_string(table.intervals()) +
                                           " intervals need " + std::to_string(wanted));
  }
  for (std::size_t i = 0; i < moves->size(); i += 3) {
    const double* m = &(*moves)[i];
    const Vec3 v{float(m[0]), float(m[1]), float(m[2])};
    if (!(dot(v, v) < 1e12f)) {
      return element.error(Code::out_of_range, "displacements of <FaceDefMesh> are too large");
    }
    table.displacements.push_back(v);
  }
  return table;
}

class TableReader {
 public:
  TableReader(XmtScene& scene, XmtFace& face) : scene_(scene), face_(face) {
    for (std::size_t i = 0; i < face.pieces.size(); ++i) {
      below_[face.pieces[i].faces].push_back(i);
      for (const SceneNode* group : face.pieces[i].above) {
        auto& pieces = below_[group];
        if (pieces.empty() || pieces.back() != i) pieces.push_back(i);
      }
    }
  }

  Result<void> read(const XmlElement& tables) {
    const auto fap = number_in(tables, "fapID");
    if (!fap) return fap.error();
    const double number = fap->value_or(1);  // the default of the node
    if (number < 1 || number > fap::kFapCount || number != std::floor(number)) {
      return tables.error(Code::out_of_range, "fapID has to be in 1..68");
    }
    fap_ = int(number);
    if (fap_ < fap::kFirstLowLevel) {
      ++high_level_;
      return {};
    }
    for (const XmlElement& field : tables.children) {
      for (const XmlElement& child : field.children) {
        const XmlElement* element = scene_.resolved(child);
        if (element == nullptr) continue;
        Result<void> done;
        if (element->name == "FaceDefMesh") done = read_mesh(*element);
        if (element->name == "FaceDefTransform") done = read_transform(*element);
        if (!done) return done;
      }
    }
    return {};
  }

  void note() {
    std::vector<std::string>& notes = face_.source.notes;
    if (high_level_ > 0) {
      notes.push_back(
          "tables of visemes and expressions are not used; FAP 1 and 2 are shown by "
          "shapes of our own");
    }
    if (homeless_ > 0) {
      notes.push_back(std::to_string(homeless_) +
                      " tables refer to no mesh of the faceSceneGraph; ignored");
    }
    if (scales_ > 0) notes.push_back("FaceDefTransform with a scale is not used");
  }

 private:
  // Of the FAP, in units of the file or rad.
  float step() const { return float(fap::step_size(fap_, face_.fapu)); }

  Result<void> read_mesh(const XmlElement& element) {
    const auto node = scene_.node_in(element, "faceSceneGraphNode");
    if (!node) return node.error();
    const std::string* moves = element.attribute("displacements");
    const std::size_t size = moves == nullptr ? 0 : moves->size();
    if (auto done = count_moves(element, size / 6); !done) return done;  // bytes of a vector
    const auto table = read_mesh_table(element);
    if (!table) return table.error();
    const std::vector<std::size_t>& pieces = pieces_below(node->get());
    for (const std::size_t i : pieces) {
      if (face_.index[i] == kNoPiece) continue;
      if (auto done = add_mesh(element, *table, face_.pieces[i], face_.index[i]); !done) {
        return done;
      }
    }
    homeless_ += pieces.empty() ? 1 : 0;
    return {};
  }

  // The pieces that are this IndexedFaceSet, or are below this group.
  const std::vector<std::size_t>& pieces_below(const SceneNode* node) const {
    static const std::vector<std::size_t> none;
    const auto found = below_.find(node);
    return node == nullptr || found == below_.end() ? none : found->second;
  }

  // Tables may be used again and again, which would multiply their moves.
  Result<void> count_moves(const XmlElement& element, std::size_t more) {
    moves_ += more + 1;
    if (moves_ <= kMostMoves) return {};
    return element.error(Code::out_of_range,
                         "the tables have more than 4 million displacements; reduce the meshes");
  }

  Result<void> add_mesh(const XmlElement& element, const MeshTable& table, const ScenePiece& piece,
                        std::size_t index) {
    const std::size_t count = face_.source.pieces[index].mesh.positions.size();
    for (const std::uint32_t v : table.vertices) {
      if (v >= count) {
        return element.error(Code::out_of_range, "coordIndex of <FaceDefMesh> names vertex " +
                                                     std::to_string(v) + " of " +
                                                     std::to_string(count));
      }
    }
    if (left_to_rig(face_.source.pieces[index], fap_)) return {};
    if (auto done = count_moves(element, table.displacements.size()); !done) return done;
    std::vector<std::pair<std::uint32_t, std::size_t>> order;
    for (std::size_t k = 0; k < table.vertices.size(); ++k) order.push_back({table.vertices[k], k});
    std::sort(order.begin(), order.end());
    for (std::size_t interval = 0; interval < table.intervals(); ++interval) {
      PieceTarget target{.control = fap_, .piece = index, .vertices = {}, .deltas = {}};
      for (const auto& [vertex, k] : order) {
        const Vec3 d = table.displacements[k * table.intervals() + interval];
        if (dot(d, d) == 0) continue;
        const Vec3 delta = piece.place.turn(d) * step();
        if (!target.vertices.empty() && target.vertices.back() == vertex) {
          target.deltas.back() += delta;
          continue;
        }
        target.vertices.push_back(vertex);
        target.deltas.push_back(delta);
      }
      // With one interval the move is straight for all values.
      if (table.intervals() > 1) {
        target.low = float(table.borders[interval]);
        target.high = float(table.borders[interval + 1]);
      }
      if (!target.vertices.empty()) face_.source.targets.push_back(std::move(target));
    }
    return {};
  }

  Result<void> read_transform(const XmlElement& element) {
    const auto node = scene_.node_in(element, "faceSceneGraphNode");
    if (!node) return node.error();
    const auto turn = numbers_of(element, "rotationDef");
    if (!turn) return turn.error();
    const auto shift = numbers_of(element, "translationDef");
    if (!shift) return shift.error();
    scales_ += element.attribute("scaleDef") != nullptr ? 1 : 0;
    const bool no_turn = turn->empty() && shift->empty();
    if (no_turn || !*node) return {};
    if ((!turn->empty() && turn->size() != 4) || (!shift->empty() && shift->size() != 3)) {
      return element.error(Code::syntax,
                           "<FaceDefTransform> needs four numbers in rotationDef, three in "
                           "translationDef");
    }
    const std::vector<std::size_t>& pieces = pieces_below(node->get());
    for (const std::size_t i : pieces) {
      const auto& above = face_.pieces[i].above;
      const auto at = std::find(above.begin(), above.end(), node->get());
      Transform outside;
      for (auto group = above.begin(); group != at; ++group) {
        if ((*group)->type == "Transform") outside = compose(outside, placement(**group));
      }
      const Vec3 centre = outside((*node)->translation + (*node)->centre);
      if (!turn->empty()) keep_centre(centre);
      const std::size_t index = face_.index[i];
      if (index == kNoPiece) continue;
      const std::size_t vertices = face_.source.pieces[index].mesh.positions.size();
      if (auto done = count_moves(element, vertices); !done) return done;
      add_transform(index, outside, centre, *turn, *shift);
    }
    homeless_ += pieces.empty() ? 1 : 0;
    return {};
  }

  // About what eyes, head and jaw turn.
  void keep_centre(Vec3 centre) {
    if (fap_ >= 23 && fap_ <= 26) face_.source.eyes[fap_ % 2 == 1 ? 0 : 1] = centre;
    if (fap_ >= 48 && fap_ <= 50) face_.source.neck_pivot = centre;
    if (fap_ == 3) face_.source.jaw_axis = centre;
  }

  void add_transform(std::size_t index, const Transform& outside, Vec3 centre,
                     const std::vector<double>& turn, const std::vector<double>& shift) {
    if (left_to_rig(face_.source.pieces[index], fap_)) return;
    const bool whole_head = fap_ >= 48 && fap_ <= 50;
    if (whole_head || fap::step_size(fap_, face_.fapu) == 0) return;
    const auto vector = [](const std::vector<double>& n) {
      return n.size() < 3 ? Vec3{} : Vec3{float(n[0]), float(n[1]), float(n[2])};
    };
    const Vec3 axis = normalised(outside.turn(vector(turn))) * (turn.empty() ? 0 : float(turn[3]));
    const Vec3 along = outside.turn(vector(shift));
    PieceTarget target{.control = fap_, .piece = index, .vertices = {}, .deltas = {}};
    const auto& places = face_.source.pieces[index].mesh.positions;
    for (std::uint32_t v = 0; v < places.size(); ++v) {
      const Vec3 delta = (cross(axis, places[v] - centre) + along) * step();
      if (!(dot(delta, delta) > 0)) continue;
      target.vertices.push_back(v);
      target.deltas.push_back(delta);
    }
    if (!target.vertices.empty()) face_.source.targets.push_back(std::move(target));
  }

  XmtScene& scene_;
  XmtFace& face_;
  std::map<const SceneNode*, std::vector<std::size_t>> below_;
  std::size_t moves_ = 0;
  int fap_ = 0;
  std::size_t high_level_ = 0;
  std::size_t homeless_ = 0;
  std::size_t scales_ = 0;
};

}  // namespace

Result<void> read_tables(const XmlElement& fdp, XmtScene& scene, XmtFace& face) {
  TableReader reader(scene, face);
  for (const XmlElement& field : fdp.children) {
    if (field.name != "faceDefTables") continue;
    for (const XmlElement& child : field.children) {
      const XmlElement* tables = scene.resolved(child);
      if (tables == nullptr || tables->name != "FaceDefTables") continue;
      if (auto done = reader.read(*tables); !done) return done;
    }
  }
  reader.note();
  return {};
}

}  // namespace animeme::head::detail
