#include "fap/head/own_head.h"

#include "fap/head/detail/own_steps.h"
#include "fap/tables.h"

namespace animeme::head {
namespace {

using detail::between;
using detail::place_of;

// Of a face, in distances of its pupils: those of ICT-FaceKit's mean head.
constexpr float kEyeRadius = 0.19f;
constexpr fap::Fapu kUsual{.irisd = 0.168, .es = 1, .ens = 0.817, .mns = 0.359, .mw = 0.859};

Error bad(std::string sentence) { return make_error(Code::invalid_argument, std::move(sentence)); }

// The bounding box of the vertices on one side, from which eyeballs are recognised.
struct Ball {
  Vec3 low, high;
  bool any = false;

  void add(Vec3 p) {
    if (!any) low = high = p;
    any = true;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  float radius() const { return 0.5f * std::max(high.x - low.x, high.y - low.y); }
  Vec3 centre() const {
    return {0.5f * (low.x + high.x), 0.5f * (low.y + high.y), high.z - radius()};
  }
};

class Assembler {
 public:
  Assembler(Source source, std::vector<std::string>* notes)
      : source_(std::move(source)), notes_(notes) {}

  Result<Head> run() {
    for (std::string& note : source_.notes) say(std::move(note));
    if (auto error = detail::check(source_)) return std::move(*error);
    if (!source_.upright && detail::turn_upright(source_)) {
      say("the head did not face +Z with +Y up: rotated");
    }
    sort_into_parts();
    if (auto error = bring_to_size()) return std::move(*error);
    fill_parts();
    if (head_.part(Part::skin).triangles.empty()) {
      return bad("there is no skin mesh: name it head or face" + taken_for_others());
    }
    head_.name = source_.name;
    head_.shapes = std::move(source_.shapes);
    set_points();
    if (auto error = set_units()) return std::move(*error);
    set_joints();
    turn_inside_out();
    detail::see_sky(head_);
    detail::colour_parts(head_);
    add_targets();
    note_what_is_missing();
    return std::move(head_);
  }

 private:
  void say(std::string note) {
    if (notes_ != nullptr) notes_->push_back(std::move(note));
  }

  // Which meshes are no skin, by which words: "; \"Body\" (material \"Top\") is not, for the word
  // \"top\"".
  std::string taken_for_others() const {
    constexpr std::size_t kMost = 4;
    std::string text;
    for (std::size_t i = 0; i < std::min(kMost, source_.pieces.size()); ++i) {
      const Piece& piece = source_.pieces[i];
      const std::string_view word = word_of_part(piece.name, piece.material);
      if (word.empty()) continue;
      text += (text.empty() ? "; not skin: mesh \"" : ", mesh \"") + piece.name + "\"";
      if (!piece.material.empty()) text += " with material \"" + piece.material + "\"";
      text += " for the word \"" + std::string(word) + "\"";
    }
    return text;
  }

  std::optional<Vec3> eye_point(std::size_t side) const {
    const char* ids[][2] = {{"3.5", "3.6"}, {"3.1", "3.2"}, {"3.3", "3.4"}};
    if (source_.eyes[side]) return source_.eyes[side];
    for (const auto& pair : ids) {
      if (auto p = place_of(source_, pair[side])) return p;
    }
    return std::nullopt;
  }

  // Which part each vertex of each piece is of, and the eyeballs.
  void sort_into_parts() {
    const auto left = eye_point(0);
    const auto right = eye_point(1);
    Ball all;
    for (const Piece& piece : source_.pieces) {
      for (const Vec3& p : piece.mesh.positions) all.add(p);
    }
    const float middle = left && right ? 0.5f * (left->x + right->x) : all.centre().x;
    std::optional<Vec3> lips = place_of(source_, "2.2");
    if (!lips) lips = between(source_, "8.3", "8.4");
    for (const Piece& piece : source_.pieces) {
      // Without a mouth, upper and lower teeth are separated by their own middle.
      Ball own;
      for (const Vec3& p : piece.mesh.positions) own.add(p);
      const float mouth = lips ? lips->y : 0.5f * (own.low.y + own.high.y);
      parts_.push_back(detail::parts_of(piece, middle, mouth));
      for (std::size_t v = 0; v < parts_.back().size(); ++v) {
        if (parts_.back()[v] == std::uint8_t(Part::left_eye))
          balls_[0].add(piece.mesh.positions[v]);
        if (parts_.back()[v] == std::uint8_t(Part::right_eye)) {
          balls_[1].add(piece.mesh.positions[v]);
        }
      }
    }
  }

  std::optional<Error> bring_to_size() {
    std::array<Vec3, 2> eyes;
    for (std::size_t side = 0; side < 2; ++side) {
      std::optional<Vec3> p = eye_point(side);
      if (!p && balls_[side].any) p = balls_[side].centre();
      if (!p) {
        return make_error(
            Code::not_found,
            "the eyes were not found: give feature points 3.5 and 3.6 (pupils) or 3.1 "
            "and 3.2 (upper lids), or name the meshes of the eyes");
      }
      eyes[side] = *p;
    }
    const double distance = double(length(eyes[0] - eyes[1]));
    if (!(distance > 0)) return bad("both eyes have the same position");
    double scale = source_.centimetres;
    if (scale == 0) {
      const detail::LengthUnit unit = detail::unit_of(distance);
      scale = unit.centimetres;
      if (unit.name.empty()) {
        say("unknown unit of length: scaled to a pupil distance of 6.3 cm");
      } else if (unit.name != "centimetres") {
        say("lengths are taken for " + std::string(unit.name));
      }
    }
    head_.centimetres = scale;
    es_ = float(distance * scale);
    // Between the centres of the eyes, which lie as far before the ears as those of usual heads.
    Vec3 middle = mix(eyes[0], eyes[1], 0.5f);
    const bool balls = balls_[0].any && balls_[1].any;
    middle.z = balls ? 0.5f * (balls_[0].centre().z + balls_[1].centre().z)
                     : middle.z - kEyeRadius * float(distance);
    const Vec3 origin = middle - Vec3{0, 0, 1.055f * float(distance)};
    detail::move_and_scale(source_, origin, float(scale));
    for (std::size_t side = 0; side < 2; ++side) {
      Ball& ball = balls_[side];
      if (ball.any) {
        ball.low = (ball.low - origin) * float(scale);
        ball.high = (ball.high - origin) * float(scale);
      }
      eyes_[side] = (eyes[side] - origin) * float(scale);
    }
    return std::nullopt;
  }

  void fill_parts() {
    index_.resize(source_.pieces.size());
    for (std::size_t i = 0; i < source_.pieces.size(); ++i) add_piece(i);
    for (std::size_t i = 0; i < source_.pieces.size(); ++i) add_facets(i, false);
    for (std::size_t i = 0; i < source_.pieces.size(); ++i) add_facets(i, true);
    head_.materials = std::move(source_.materials);
    for (std::size_t p = 0; p < head_.parts.size(); ++p) {
      Mesh& mesh = head_.parts[p];
      // Shadows are either known for a whole part or found for all of it.
      if (mesh.occlusion.size() != mesh.positions.size()) mesh.occlusion.clear();
    }
    if (neck_.size() == head_.part(Part::skin).positions.size() && neck_given_) {
      head_.seams.neck_weights = std::move(neck_);
    }
  }

  void add_piece(std::size_t i) {
    Piece& piece = source_.pieces[i];
    const std::vector<std::uint8_t>& parts = parts_[i];
    std::vector<std::uint32_t>& index = index_[i];
    index.assign(parts.size(), kMissing);
    const bool coloured = piece.mesh.colours.size() == parts.size();
    const bool shaded = piece.mesh.occlusion.size() == parts.size();
    const bool weighed = piece.neck_weights.size() == parts.size();
    const Vec3 usual = colour_by_name(piece.name, piece.material);
    for (std::size_t v = 0; v < parts.size(); ++v) {
      if (parts[v] >= kPartCount) continue;
      Mesh& mesh = head_.parts[parts[v]];
      index[v] = std::uint32_t(mesh.positions.size());
      mesh.positions.push_back(piece.mesh.positions[v]);
      mesh.colours.push_back(coloured ? piece.mesh.colours[v] : usual);
      if (shaded) mesh.occlusion.push_back(piece.mesh.occlusion[v]);
      if (Part(parts[v]) != Part::skin) continue;
      neck_.push_back(weighed ? piece.neck_weights[v] : 1);
      neck_given_ = neck_given_ || weighed;
    }
    for (const Triangle& t : piece.mesh.triangles) {
      if (parts[t[0]] >= kPartCount) continue;
      piece_of_[parts[t[0]]].push_back(std::uint32_t(i));
      head_.parts[parts[t[0]]].triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
    }
  }

  // The triangles of a piece as they are drawn, or its transparent ones, which follow those of all
  // pieces.
  void add_facets(std::size_t i, bool transparent) {
    const Mesh& from = source_.pieces[i].mesh;
    const std::size_t solid = std::min(from.triangles.size(), from.facets.size());
    std::vector<std::uint32_t> numbers(from.corners.size(), kMissing);  // in the part
    for (std::size_t f = transparent ? solid : 0; f < (transparent ? from.facets.size() : solid);
         ++f) {
      const std::uint8_t part = parts_[i][from.corners[from.facets[f][0]].vertex];
      if (part >= kPartCount) continue;
      Mesh& mesh = head_.parts[part];
      Triangle facet{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = from.facets[f][k];
        if (numbers[corner] == kMissing) {
          numbers[corner] = std::uint32_t(mesh.corners.size());
          mesh.corners.push_back(from.corners[corner]);
          mesh.corners.back().vertex = index_[i][from.corners[corner].vertex];
        }
        facet[k] = numbers[corner];
      }
      mesh.facets.push_back(facet);
      mesh.materials.push_back(from.materials[f]);
    }
  }

  void set_points() {
    for (const PiecePoint& point : source_.points) {
      const std::uint32_t vertex = index_[point.piece][point.vertex];
      if (vertex == kMissing) continue;
      for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
        if (fap::kFeaturePoints[i].id != point.id) continue;
        head_.feature_points[i] = {Part(parts_[point.piece][point.vertex]), vertex};
      }
    }
  }

  // A head that shapes move and that cannot blink: its eyes are as wide open as usual.
  void add_usual_lids(fap::FeaturePoints& places) const {
    for (const char* lid : {"3.1", "3.2", "3.3", "3.4"}) {
      if (places.count(lid) > 0) return;
    }
    const double half = 0.5 * kUsual.irisd * double(es_);
    const Vec3 eye = eyes_[0];
    places["3.1"] = {eye.x, eye.y + half, eye.z};
    places["3.3"] = {eye.x, eye.y - half, eye.z};
  }

  std::optional<Error> set_units() {
    if (source_.fapu) {
      head_.fapu = *source_.fapu;
      return std::nullopt;
    }
    fap::FeaturePoints places;
    for (std::size_t i = 0; i < head_.feature_points.size(); ++i) {
      if (!head_.feature_points[i].exists()) continue;
      const std::string id(fap::kFeaturePoints[i].id);
      const Vec3 p = head_.at(id);
      places[id] = {p.x, p.y, p.z};
    }
    for (const auto& [id, eye] : {std::pair("3.5", eyes_[0]), std::pair("3.6", eyes_[1])}) {
      places.try_emplace(id, fap::Point{eye.x, eye.y, eye.z});
    }
    if (!head_.shapes.empty()) add_usual_lids(places);
    Result<fap::Fapu> measured = fap::measure_fapu(places);
    if (measured) {
      head_.fapu = *measured;
      return std::nullopt;
    }
    if (head_.shapes.empty()) return measured.error();
    const double es = double(es_);
    head_.fapu = {kUsual.irisd * es, es, kUsual.ens * es, kUsual.mns * es, kUsual.mw * es};
    return std::nullopt;
  }

  void set_joints() {
    for (std::size_t side = 0; side < 2; ++side) {
      Eye& eye = head_.eyes[side];
      const Ball& ball = balls_[side];
      eye.radius = ball.any ? ball.radius() : kEyeRadius * es_;
      eye.centre = ball.any ? ball.centre() : eyes_[side] - Vec3{0, 0, eye.radius};
      if (source_.eyes[side]) eye.centre = *source_.eyes[side];
      eye.iris_radius = std::min(0.5f * float(head_.fapu.irisd) * 1.15f, 0.6f * eye.radius);
      eye.pupil_radius = 0.45f * eye.iris_radius;
    }
    // As on the heads of this folder, whose pupils are as far apart.
    head_.jaw_axis = source_.jaw_axis.value_or(Vec3{0, -0.375f, 0.094f} * es_);
    head_.neck_pivot = source_.neck_pivot.value_or(Vec3{0, -0.97f, -0.34f} * es_);
  }

  void turn_inside_out() {
    for (const detail::TurnedPiece& found : detail::turn_inside_out(head_, es_, piece_of_)) {
      const Piece& piece = source_.pieces[found.piece];
      const std::string name = !piece.name.empty() ? piece.name : piece.material;
      const std::string mesh =
          name.empty() ? "mesh " + std::to_string(found.piece + 1) : "mesh \"" + name + "\"";
      say(mesh + ": flipped " + (found.turned == found.triangles ? "all " : "") +
          std::to_string(found.turned) + " inside-out triangles");
    }
  }

  void add_targets() {
    for (const PieceTarget& target : source_.targets) {
      std::array<Target, kPartCount> by_part;
      for (std::size_t k = 0; k < target.vertices.size(); ++k) {
        const std::uint32_t v = index_[target.piece][target.vertices[k]];
        if (v == kMissing) continue;
        Target& out = by_part[parts_[target.piece][target.vertices[k]]];
        out.vertices.push_back(v);
        out.deltas.push_back(target.deltas[k]);
      }
      for (std::size_t part = 0; part < by_part.size(); ++part) {
        if (by_part[part].vertices.empty()) continue;
        by_part[part].control = target.control;
        by_part[part].part = Part(part);
        by_part[part].low = target.low;
        by_part[part].high = target.high;
        head_.targets.push_back(std::move(by_part[part]));
      }
    }
    std::stable_sort(head_.targets.begin(), head_.targets.end(),
                     [](const Target& a, const Target& b) { return a.control < b.control; });
  }

  void note_what_is_missing() {
    for (std::size_t side = 0; side < 2; ++side) {
      const Part part = side == 0 ? Part::left_eye : Part::right_eye;
      if (head_.part(part).positions.empty() && head_.shapes.empty()) {
        say(std::string("there is no mesh of the ") + (side == 0 ? "left" : "right") +
            " eye, so gaze is not visible (name one eyeLeft, eyeRight)");
      }
    }
    if (!head_.targets.empty()) return;
    std::string still;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (fap::move_of(fap).kind != fap::MoveKind::translate) continue;
      const std::string_view id = fap::info(fap).feature_point;
      if (head_.point(id).exists() || (fap >= 27 && fap <= 30)) continue;
      still += (still.empty() ? "" : ", ") + std::string(fap::info(fap).name) + " (" +
               std::string(id) + ")";
    }
    if (!still.empty())
      say("these FAPs have no effect, since the head lacks their feature points: " + still);
  }

  Source source_;
  std::vector<std::string>* notes_;
  Head head_;
  std::vector<std::vector<std::uint8_t>> parts_;   // piece, vertex
  std::vector<std::vector<std::uint32_t>> index_;  // number in the part
  detail::PieceOfTriangle piece_of_;
  std::array<Ball, 2> balls_;
  std::array<Vec3, 2> eyes_;  // as far as known: pupils, lids or centres
  float es_ = 1;
  std::vector<float> neck_;
  bool neck_given_ = false;
};

}  // namespace

Result<Head> assemble(Source source, std::vector<std::string>* notes) {
  return Assembler(std::move(source), notes).run();
}

}  // namespace animeme::head
