#include "fap/head/detail/own_steps.h"

#include <set>

#include "fap/tables.h"

namespace animeme::head::detail {
namespace {

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Error bad(std::string sentence) { return make_error(Code::invalid_argument, std::move(sentence)); }

std::string title(const Source& source, std::size_t piece) {
  const Piece& p = source.pieces[piece];
  return p.name.empty() ? "mesh " + std::to_string(piece + 1) : "mesh " + p.name;
}

std::optional<Error> check_piece(const Source& source, std::size_t i) {
  const Mesh& mesh = source.pieces[i].mesh;
  const std::size_t count = mesh.positions.size();
  for (const Vec3& p : mesh.positions) {
    if (!finite(p)) return bad(title(source, i) + " has a vertex that is not finite");
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (v >= count) {
        return bad(title(source, i) + " has a triangle with vertex " + std::to_string(v) + " of " +
                   std::to_string(count));
      }
    }
  }
  // Facets come from readers alone, which number them themselves.
  bool fine = mesh.facets.size() == mesh.materials.size() &&
              (mesh.facets.empty() || mesh.facets.size() >= mesh.triangles.size());
  for (const Corner& corner : mesh.corners) fine = fine && corner.vertex < count;
  for (const Triangle& t : mesh.facets) {
    for (const std::uint32_t c : t) fine = fine && c < mesh.corners.size();
  }
  for (const std::uint16_t material : mesh.materials)
    fine = fine && material < source.materials.size();
  if (!fine) return bad(title(source, i) + " has facets with invalid indices");
  return std::nullopt;
}

std::optional<Error> check_points(const Source& source) {
  std::set<std::string> seen;
  for (const PiecePoint& point : source.points) {
    const bool known =
        std::any_of(fap::kFeaturePoints.begin(), fap::kFeaturePoints.end(),
                    [&](const fap::FeaturePointInfo& info) { return info.id == point.id; });
    if (!known) {
      return make_error(Code::not_found, "there is no feature point " + point.id +
                                             "; they are 2.1 to 11.6 (MPEG-4)");
    }
    if (!seen.insert(point.id).second) {
      return bad("feature point " + point.id + " is given twice");
    }
    if (point.piece >= source.pieces.size() ||
        point.vertex >= source.pieces[point.piece].mesh.positions.size()) {
      return bad("feature point " + point.id + " is vertex " + std::to_string(point.vertex) +
                 ", which does not exist; vertices are counted from 0");
    }
  }
  return std::nullopt;
}

std::optional<Error> check_targets(const Source& source) {
  for (const PieceTarget& target : source.targets) {
    const int last = kFirstShape + int(source.shapes.size());
    if (target.control < fap::kFirstLowLevel || target.control >= last) {
      return bad("a target has control " + std::to_string(target.control) +
                 ", which is neither a FAP nor a shape of the head");
    }
    const std::size_t vertices =
        target.piece < source.pieces.size() ? source.pieces[target.piece].mesh.positions.size() : 0;
    if (target.deltas.size() != target.vertices.size() ||
        !std::is_sorted(target.vertices.begin(), target.vertices.end()) ||
        (!target.vertices.empty() && target.vertices.back() >= vertices) ||
        !std::all_of(target.deltas.begin(), target.deltas.end(), finite)) {
      return bad("a target has invalid vertex indices or displacements that are not finite");
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> check(const Source& source) {
  for (std::size_t i = 0; i < source.pieces.size(); ++i) {
    if (auto error = check_piece(source, i)) return error;
  }
  if (auto error = check_points(source)) return error;
  return check_targets(source);
}

}  // namespace animeme::head::detail
