#include "tools/view/gltf/detail/head_reader.h"

#include <algorithm>
#include <map>
#include <set>

#include "tools/view/gltf/detail/arms.h"
#include "tools/view/gltf/detail/brow_clearance.h"
#include "tools/view/gltf/detail/paint.h"
#include "tools/view/gltf/detail/point_guess.h"
#include "tools/view/gltf/detail/primitive.h"
#include "tools/view/gltf/detail/refine.h"
#include "tools/view/gltf/detail/vertex_keys.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace {

using head::Vec3;

// What the steps of reading hand on.
class HeadReader {
 public:
  HeadReader(const File& file, const ReadOptions& options) : file_(file), options_(options) {}

  Result<MovedHead> read() {
    auto nodes = read_nodes(file_);
    if (!nodes) return nodes.error();
    joints_ = find_joints(file_, *nodes);
    lower_arms(file_, *nodes);
    const bool keep_materials = options_.vertices == 0;
    Paints paints(file_, options_.load, source_.notes, keep_materials);
    ShapeNames names;
    auto pieces = MeshReader(file_, *nodes, joints_, paints, options_.rules).read(names);
    if (!pieces) return pieces.error();
    pieces_ = std::move(*pieces);
    if (options_.vertices > 0) refine(pieces_, options_.vertices);
    const bool with_materials =
        keep_materials && std::any_of(pieces_.begin(), pieces_.end(),
                                      [](const RawPiece& piece) { return piece.paint->textured; });
    for (RawPiece& piece : pieces_) {
      if (with_materials) add_corners(piece);
      paint(piece);
    }
    if (with_materials) source_.materials = paints.take_materials();
    drop_unseen();
    if (pieces_.empty()) {
      return make_error(Code::not_found, "there is no triangle to show in the file");
    }
    if (auto known = check_rules(options_.rules, names.names()); !known) return known.error();
    shapes_ = choose_shapes(names.names(), options_.mouth, source_.notes, options_.rules);
    shape_of_name_.assign(names.names().size(), kNone);
    rank_of_name_.assign(names.names().size(), 0);
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      for (std::size_t rank = 0; rank < shapes_[i].names.size(); ++rank) {
        shape_of_name_[shapes_[i].names[rank]] = i;
        rank_of_name_[shapes_[i].names[rank]] = rank;
      }
    }
    for (RawPiece& piece : pieces_) drop_further_names(piece);
    mark_faces(pieces_, shapes_, shape_of_name_);
    join_primitives();
    for (RawPiece& piece : pieces_) weld(piece);
    place_joints(*nodes);
    turn_upright();
    source_.points = guess_points({pieces_, shapes_, shape_of_name_});
    source_.upright = true;
    drop_far_joints();
    keep_brows();
    write_shapes();
    write_pieces();
    std::vector<std::vector<std::string>> shape_names;
    for (const ChosenShape& shape : shapes_) {
      shape_names.emplace_back();
      for (const std::size_t name : shape.names) shape_names.back().push_back(names.names()[name]);
    }
    return MovedHead{
        {std::move(source_), std::move(meshes_), unknown_names(names.names(), options_.rules)},
        std::move(shape_names),
        turning_joints(),
        axes_};
  }

 private:
  // Glass, and what alpha has made empty.
  void drop_unseen() {
    std::set<std::string> names;
    std::erase_if(pieces_, [&](const RawPiece& piece) {
      if (!piece.transparent.empty()) return false;
      if (!piece.triangles.empty() && !piece.paint->see_through) return false;
      names.insert(piece.name);
      return true;
    });
    for (const std::string& name : names) {
      source_.notes.push_back("\"" + name + "\" is transparent and is left out");
    }
  }

  // Of several names of one shape in a piece the preferred one shows it: all of them would add up.
  void drop_further_names(RawPiece& piece) const {
    std::map<std::size_t, std::size_t> best;  // rank by shape
    for (const PieceMorph& morph : piece.morphs) {
      const std::size_t shape = shape_of_name_[morph.shape];
      if (shape == kNone) continue;
      const auto [place, is_new] = best.try_emplace(shape, rank_of_name_[morph.shape]);
      if (!is_new) place->second = std::min(place->second, rank_of_name_[morph.shape]);
    }
    std::erase_if(piece.morphs, [&](const PieceMorph& morph) {
      const std::size_t shape = shape_of_name_[morph.shape];
      return shape != kNone && rank_of_name_[morph.shape] > best[shape];
    });
  }

  // Programs cut a mesh where its material changes; the light on the skin should not. Other parts
  // stay apart: the name of their material identifies them.
  void join_primitives() {
    std::vector<RawPiece> joined;
    for (RawPiece& piece : pieces_) {
      const auto part = part_of(piece);
      const auto same = std::find_if(joined.begin(), joined.end(), [&](const RawPiece& other) {
        return part == head::Part::skin && other.node == piece.node && part_of(other) == part &&
               other.neck_weights.empty() == piece.neck_weights.empty();
      });
      if (same == joined.end()) {
        joined.push_back(std::move(piece));
      } else {
        append(*same, std::move(piece));
      }
    }
    pieces_ = std::move(joined);
  }

  static void append(RawPiece& to, RawPiece from) {
    to.face = to.face || from.face;
    const auto first = std::uint32_t(to.positions.size());
    to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
    to.colours.insert(to.colours.end(), from.colours.begin(), from.colours.end());
    to.numbers.insert(to.numbers.end(), from.numbers.begin(), from.numbers.end());
    to.neck_weights.insert(to.neck_weights.end(), from.neck_weights.begin(),
                           from.neck_weights.end());
    // The materials are those of triangles, then of transparent ones.
    const auto solid = std::ptrdiff_t(from.triangles.size() * (from.materials.empty() ? 0 : 1));
    to.materials.insert(
        to.materials.begin() + std::ptrdiff_t(to.materials.empty() ? 0 : to.triangles.size()),
        from.materials.begin(), from.materials.begin() + solid);
    to.materials.insert(to.materials.end(), from.materials.begin() + solid, from.materials.end());
    for (const auto& [more, all] : {std::pair(&from.triangles, &to.triangles),
                                    std::pair(&from.transparent, &to.transparent)}) {
      for (const head::Triangle& t : *more) {
        all->push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
    to.corners.insert(to.corners.end(), from.corners.begin(), from.corners.end());
    for (PieceMorph& morph : from.morphs) {
      auto place = std::find_if(to.morphs.begin(), to.morphs.end(),
                                [&](const PieceMorph& m) { return m.shape >= morph.shape; });
      if (place == to.morphs.end() || place->shape != morph.shape) {
        place = to.morphs.insert(place, PieceMorph{morph.shape, {}});
      }
      for (const std::uint32_t v : morph.moves.vertices) {
        place->moves.vertices.push_back(v + first);
      }
      place->moves.deltas.insert(place->moves.deltas.end(), morph.moves.deltas.begin(),
                                 morph.moves.deltas.end());
    }
  }

  void place_joints(const std::vector<Node>& nodes) {
    const auto at = [&](std::size_t bone) -> std::optional<Vec3> {
      if (bone == kNoNode) return std::nullopt;
      return Vec3(nodes[bone].world.origin());
    };
    source_.neck_pivot = at(joints_.head);
    source_.jaw_axis = at(joints_.jaw);
    // One eye is no pair.
    if (joints_.eyes[0] != kNoNode && joints_.eyes[1] != kNoNode) {
      source_.eyes = {at(joints_.eyes[0]), at(joints_.eyes[1])};
    }
  }

  void turn_upright() {
    const auto axes = axes_of({pieces_, shapes_, shape_of_name_}, source_.eyes);
    if (!axes || *axes == std::array<Vec3, 3>{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) return;
    axes_ = *axes;
    const auto turn = [&](Vec3& v) {
      v = {head::dot((*axes)[0], v), head::dot((*axes)[1], v), head::dot((*axes)[2], v)};
    };
    for (RawPiece& piece : pieces_) {
      for (Vec3& p : piece.positions) turn(p);
      for (head::Corner& corner : piece.corners) turn(corner.normal);
      for (PieceMorph& morph : piece.morphs) {
        for (Vec3& d : morph.moves.deltas) turn(d);
      }
    }
    for (std::optional<Vec3>* place :
         {&source_.neck_pivot, &source_.jaw_axis, &source_.eyes[0], &source_.eyes[1]}) {
      if (*place) turn(**place);
    }
    // VRM 0 looks along -Z, as it should.
    const bool vrm = !member(file_.root, "extensions", "VRM").is_null();
    const bool half_turn = axes_ == std::array<Vec3, 3>{Vec3{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    if (vrm && half_turn) return;
    source_.notes.push_back(
        "the head does not look along +Z with +Y up, as it should in glTF; it "
        "was turned as its shapes say");
  }

  std::optional<Vec3> place_of(std::string_view id) const {
    for (const head::PiecePoint& point : source_.points) {
      if (point.id == id) return pieces_[point.piece].positions[point.vertex];
    }
    return std::nullopt;
  }

  // Not all that is called a head or an eye is a bone in its place: groups of meshes have such
  // names, too, and stand at the origin.
  void drop_far_joints() {
    const std::optional<Vec3> left = place_of("3.1"), right = place_of("3.2");
    if (!left || !right) return;
    const float distance = head::length(*left - *right);
    const auto is_near = [&](std::optional<Vec3>& joint, Vec3 place, float most) {
      if (joint && head::length(*joint - place) > most * distance) joint.reset();
    };
    is_near(source_.eyes[0], *left, 0.7f);
    is_near(source_.eyes[1], *right, 0.7f);
    if (!source_.eyes[0] || !source_.eyes[1]) source_.eyes = {};
    const Vec3 middle = (*left + *right) * 0.5f;
    is_near(source_.jaw_axis, middle, 1.7f);
    is_near(source_.neck_pivot, middle, 3.5f);
    // A head turns about what is below and behind its eyes.
    if (source_.neck_pivot &&
        (source_.neck_pivot->y > middle.y || source_.neck_pivot->z > middle.z)) {
      source_.neck_pivot.reset();
    }
  }

  void keep_brows() {
    const std::optional<Vec3> left = place_of("3.1"), right = place_of("3.2");
    if (!left || !right) return;
    const std::size_t shapes = keep_brows_in_front(pieces_, {pieces_, shapes_, shape_of_name_},
                                                   head::length(*left - *right));
    if (shapes == 0) return;
    source_.notes.push_back("the skin hid parts of the brows in " + std::to_string(shapes) +
                            (shapes == 1 ? " shape" : " shapes") + "; they stay in front of it");
  }

  // Those whose places are what the head turns about.
  HeadJoints turning_joints() const {
    HeadJoints joints = joints_;
    if (!source_.neck_pivot) {
      joints.head = kNoNode;
      joints.neck.clear();
    }
    if (!source_.eyes[0]) joints.eyes = {kNoNode, kNoNode};
    if (!source_.jaw_axis || jaw_moves_skin_) joints.jaw = kNoNode;
    return joints;
  }

  void write_shapes() {
    for (const ChosenShape& shape : shapes_) {
      source_.shapes.push_back(control_of(shape));
    }
    if (shapes_.empty()) {
      source_.notes.push_back(
          "no morph target has a name that is known (ARKit, Oculus visemes, VRM): the head can "
          "only be moved by its feature points");
    }
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      std::set<std::size_t> done;  // two names of one shape in one piece would add up
      for (PieceMorph& morph : pieces_[p].morphs) {
        const std::size_t shape = shape_of_name_[morph.shape];
        if (shape == kNone || !done.insert(shape).second) continue;
        head::PieceTarget target;
        target.control = head::kFirstShape + int(shape);
        target.piece = p;
        target.vertices = std::move(morph.moves.vertices);
        target.deltas = std::move(morph.moves.deltas);
        for (Vec3& d : target.deltas) d *= 1 / head::kFullShape;
        source_.targets.push_back(std::move(target));
      }
    }
    std::stable_sort(source_.targets.begin(), source_.targets.end(),
                     [](const head::PieceTarget& a, const head::PieceTarget& b) {
                       return a.control < b.control;
                     });
  }

  void write_pieces() {
    std::vector<std::size_t> nodes;  // by mesh
    for (RawPiece& piece : pieces_) {
      auto mesh = std::size_t(std::find(nodes.begin(), nodes.end(), piece.node) - nodes.begin());
      if (mesh == nodes.size()) {
        nodes.push_back(piece.node);
        meshes_.push_back({piece.name, false, {}});
      }
      MeshVertices& vertices = meshes_[mesh];
      const bool is_skin = part_of(piece) == head::Part::skin;
      vertices.skin = vertices.skin || is_skin;
      jaw_moves_skin_ = jaw_moves_skin_ || (is_skin && piece.on_jaw);
      for (const FileVertex& v : piece.file_vertices) {
        if (v.number >= vertices.vertices.size()) vertices.vertices.resize(v.number + 1);
        vertices.vertices[v.number] = {source_.pieces.size(), v.vertex};
      }
      head::Piece out;
      out.name = std::move(piece.name);
      out.material = piece.paint->name;
      out.face = piece.face;
      out.mesh.positions = std::move(piece.positions);
      out.mesh.triangles = std::move(piece.triangles);
      out.mesh.corners = std::move(piece.corners);
      out.mesh.facets = std::move(piece.facets);
      out.mesh.materials = std::move(piece.materials);
      bool any = false;
      for (const Colour& colour : piece.colours) {
        // Means of known and unknown colours are unknown, too.
        const bool known = std::min({colour.rgb.x, colour.rgb.y, colour.rgb.z}) >= 0;
        any = any || known;
        out.mesh.colours.push_back(known ? colour.rgb : head::kNoColour);
      }
      if (!any) out.mesh.colours.clear();
      out.neck_weights = std::move(piece.neck_weights);
      source_.pieces.push_back(std::move(out));
    }
  }

  const File& file_;
  const ReadOptions& options_;
  head::Source source_;
  std::vector<RawPiece> pieces_;
  std::vector<ChosenShape> shapes_;
  std::vector<std::size_t> shape_of_name_;
  std::vector<std::size_t> rank_of_name_;  // of those of a shape; the first one is preferred
  std::vector<MeshVertices> meshes_;
  HeadJoints joints_;
  std::array<Vec3, 3> axes_ = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  bool jaw_moves_skin_ = false;
};

}  // namespace

Result<MovedHead> read_moved_head(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  Result<File> file = open_file(bytes, options.load, options.limits);
  if (!file) return file.error();
  return HeadReader(*file, options).read();
}

}  // namespace animeme::gltf
