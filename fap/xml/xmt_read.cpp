#include <cmath>

#include "fap/xml/detail/xmt_tables.h"
#include "fap/xml/xmt.h"

namespace animeme::head {
namespace {

using detail::kNoPiece;
using detail::SceneNodePtr;
using detail::ScenePiece;
using detail::XmlElement;
using detail::XmtFace;
using detail::XmtScene;

constexpr float kNowhere = 1e30f;  // larger places are none
class Reader {
 public:
  explicit Reader(const XmlElement& root) : root_(root), scene_(root) {}

  Result<Source> run() {
    fdp_ = detail::find_element(root_, "FDP");
    if (fdp_ == nullptr) {
      return root_.error(Code::not_found, "there is no FDP node in <" + root_.name + ">");
    }
    if (auto done = read_meshes(); !done) return done.error();
    if (auto done = read_places(); !done) return done.error();
    const auto fapu = fap::measure_fapu(places_);
    if (!fapu) return fdp_->error(fapu.error().code, "featurePointsCoord: " + fapu.error().message);
    face_.fapu = *fapu;
    face_.source.fapu = *fapu;
    if (auto done = read_tables(*fdp_, scene_, face_); !done) return done.error();
    detail::set_points(places_, face_);
    for (const std::string& name : scene_.missing()) {
      face_.source.notes.push_back("USE of " + name + ", which no DEF defines; ignored");
    }
    face_.source.upright = true;  // FAPU are measured along the axes
    return std::move(face_.source);
  }

 private:
  Result<void> read_meshes() {
    std::vector<SceneNodePtr> roots;
    for (const XmlElement& field : fdp_->children) {
      if (field.name != "faceSceneGraph") continue;
      for (const XmlElement& child : field.children) {
        if (!detail::is_node(child)) continue;
        auto node = scene_.node(child);
        if (!node) return node.error();
        if (*node) roots.push_back(std::move(*node));
      }
    }
    auto pieces = detail::scene_pieces(roots);
    if (!pieces) return pieces.error();
    face_.pieces = std::move(*pieces);
    for (ScenePiece& piece : face_.pieces) {
      const bool empty = piece.piece.mesh.triangles.empty();
      face_.index.push_back(empty ? kNoPiece : face_.source.pieces.size());
      if (!empty) face_.source.pieces.push_back(std::move(piece.piece));
    }
    if (!face_.source.pieces.empty()) return {};
    return fdp_->error(Code::not_found,
                       "the FDP has no mesh in faceSceneGraph, only points for a face that the "
                       "player has; give --points and a mesh instead");
  }

  Result<void> read_places() {
    const auto node = scene_.node_in(*fdp_, "featurePointsCoord");
    if (!node) return node.error();
    if (!*node) return fdp_->error(Code::not_found, "the FDP has no featurePointsCoord");
    const std::vector<Vec3>& values = (*node)->values;
    const std::size_t count = std::min(values.size(), fap::kFeaturePoints.size());
    if (values.size() != fap::kFeaturePoints.size()) {
      face_.source.notes.push_back(
          "featurePointsCoord has " + std::to_string(values.size()) +
          " positions, not 84; the first ones are used in the order of the "
          "standard");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = values[i];
      if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kNowhere) continue;
      places_[std::string(fap::kFeaturePoints[i].id)] = {p.x, p.y, p.z};
    }
    return {};
  }

  const XmlElement& root_;
  XmtScene scene_;
  const XmlElement* fdp_ = nullptr;
  XmtFace face_;
  fap::FeaturePoints places_;
};

}  // namespace

Result<Source> read_xmt(std::string_view text) {
  const auto root = detail::parse_xml(text);
  if (!root) return root.error();
  return Reader(*root).run();
}

}  // namespace animeme::head
