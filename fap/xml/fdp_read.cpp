#include <algorithm>
#include <map>
#include <set>

#include "fap/xml/detail/fdp_file.h"
#include "fap/xml/detail/moves.h"

namespace animeme::head {
namespace {

using detail::FdpFile;
using detail::FdpMesh;
using detail::XfaceItem;

bool is_feature_point(std::string_view id) {
  return std::any_of(fap::kFeaturePoints.begin(), fap::kFeaturePoints.end(),
                     [&](const fap::FeaturePointInfo& info) { return info.id == id; });
}

class Converter {
 public:
  explicit Converter(FdpFile file) : file_(std::move(file)) {}

  Result<Source> run() {
    if (file_.pieces.empty()) {
      return make_error(Code::not_found, "the meshes of the entity Rest have no triangle");
    }
    source_.notes = std::move(file_.notes);
    source_.pieces = std::move(file_.pieces);
    add_points();
    if (auto done = find_fapu(); !done) return done.error();
    for (std::size_t m = 0; m < file_.meshes.size(); ++m) add_targets(m);
    note_unused_faps();
    source_.eyes = file_.eyes;
    source_.upright = true;  // FAPs move along X, Y and Z
    return std::move(source_);
  }

 private:
  void add_points() {
    std::set<std::string> seen;
    for (const XfaceItem& item : file_.items) {
      const ObjFile::Place place = file_.meshes[item.mesh].where[item.pivot];
      if (place.vertex == kMissing || !is_feature_point(item.name)) continue;
      if (!seen.insert(item.name).second) continue;
      source_.points.push_back({item.name, place.piece, place.vertex});
    }
    if (source_.points.empty()) source_.notes.push_back("no <fdp> is named after a feature point");
  }

  // Units that the file lacks are measured.
  Result<void> find_fapu() {
    fap::Fapu& f = file_.fapu;
    if (f.es > 0 && f.irisd > 0 && f.ens > 0 && f.mns > 0 && f.mw > 0) {
      source_.fapu = f;
      return {};
    }
    fap::FeaturePoints places;
    for (const PiecePoint& p : source_.points) {
      const Vec3 v = source_.pieces[p.piece].mesh.positions[p.vertex];
      places[p.id] = {v.x, v.y, v.z};
    }
    const auto measured = fap::measure_fapu(places);
    if (!measured) return measured.error();
    const auto fill = [](double& value, double otherwise) {
      if (value <= 0) value = otherwise;
    };
    fill(f.es, measured->es);
    fill(f.irisd, measured->irisd);
    fill(f.ens, measured->ens);
    fill(f.mns, measured->mns);
    fill(f.mw, measured->mw);
    source_.fapu = f;
    return {};
  }

  void add_targets(std::size_t m) {
    const FdpMesh& mesh = file_.meshes[m];
    detail::XfaceMesh moves(mesh.positions);
    for (const XfaceItem& item : file_.items) {
      if (item.mesh == m) moves.add(item);
    }
    if (moves.lost() > 0) {
      source_.notes.push_back(mesh.names.front() + ": " + std::to_string(moves.lost()) +
                              " influences beyond the eighth of a vertex are ignored, as in Xface");
    }
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const float step = float(detail::xface_step(fap, *source_.fapu));
      if (step == 0) continue;
      add_target(mesh, fap, mesh.place.turn(detail::xface_direction(fap)) * step,
                 moves.factors(fap));
    }
  }

  void add_target(const FdpMesh& mesh, int fap, Vec3 unit, const std::vector<float>& factors) {
    std::map<std::size_t, std::vector<std::pair<std::uint32_t, Vec3>>> by_piece;
    for (std::size_t v = 0; v < factors.size(); ++v) {
      const ObjFile::Place place = mesh.where[v];
      if (factors[v] == 0 || place.vertex == kMissing) continue;
      by_piece[place.piece].push_back({place.vertex, unit * factors[v]});
    }
    for (auto& [piece, moves] : by_piece) {
      if (detail::left_to_rig(source_.pieces[piece], fap)) continue;
      std::sort(moves.begin(), moves.end(),
                [](const auto& a, const auto& b) { return a.first < b.first; });
      PieceTarget target{.control = fap, .piece = piece, .vertices = {}, .deltas = {}};
      for (const auto& [vertex, delta] : moves) {
        target.vertices.push_back(vertex);
        target.deltas.push_back(delta);
      }
      source_.targets.push_back(std::move(target));
    }
  }

  void note_unused_faps() {
    std::set<int> unused;
    for (const XfaceItem& item : file_.items) {
      for (const detail::XfaceInfluence& influence : item.influences) {
        if (detail::xface_step(influence.fap, *source_.fapu) == 0) unused.insert(influence.fap);
      }
    }
    if (unused.empty()) return;
    std::string text = "influences of FAPs that move no vertex are ignored:";
    for (const int fap : unused) text += " " + std::to_string(fap);
    source_.notes.push_back(text);
  }

  FdpFile file_;
  Source source_;
};

}  // namespace

Result<Source> read_fdp(std::string_view text, const LoadMeshFile& load) {
  auto file = detail::load_fdp(text, load);
  if (!file) return file.error();
  return Converter(std::move(*file)).run();
}

}  // namespace animeme::head
