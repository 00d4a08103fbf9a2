// Points of a list on the vertices of a file.
#include <algorithm>

#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

Result<std::vector<head::PiecePoint>> points_on(const HeadFile& file,
                                                const std::vector<head::PointRow>& rows) {
  std::vector<head::PiecePoint> points;
  for (const head::PointRow& row : rows) {
    if (!row.vertex) {
      auto nearest = head::points_on(file.source.pieces, {row});
      if (!nearest) return nearest;
      points.push_back(std::move(nearest->front()));
      continue;
    }
    const auto mesh = std::find_if(file.meshes.begin(), file.meshes.end(), [&](const auto& m) {
      return row.mesh.empty()
                 ? m.skin
                 : (" " + m.name + " ").find(" " + row.mesh + " ") != std::string::npos;
    });
    const bool found = mesh != file.meshes.end() && *row.vertex < mesh->vertices.size() &&
                       mesh->vertices[*row.vertex].vertex != head::kMissing;
    if (!found) {
      return error_at_line(Code::not_found,
                           "point " + row.id + ": there is no vertex " +
                               std::to_string(*row.vertex) + " that is shown" +
                               (row.mesh.empty() ? "" : " in mesh " + row.mesh),
                           row.line);
    }
    const PieceVertex place = mesh->vertices[*row.vertex];
    points.push_back({row.id, place.piece, place.vertex});
  }
  return points;
}

}  // namespace animeme::gltf
