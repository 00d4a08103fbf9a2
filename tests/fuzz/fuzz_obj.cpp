// Any bytes as an OBJ file and, after a zero byte, a list of points on it: an answer without a
// crash, and what was read holds together.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "fap/head/obj.h"
#include "fap/head/point_list.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;

void check(const head::ObjFile& file) {
  require(!file.pieces.empty());
  for (const head::Piece& piece : file.pieces) {
    const std::size_t count = piece.mesh.positions.size();
    require(count > 0 && piece.mesh.colours.size() == count && !piece.mesh.triangles.empty());
    for (const head::Triangle& t : piece.mesh.triangles) {
      for (const std::uint32_t v : t) require(v < count);
    }
    for (const head::Vec3& p : piece.mesh.positions) {
      require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
  }
  for (const head::ObjFile::Place& place : file.vertices) {
    if (place.vertex == head::kMissing) continue;
    require(place.piece < file.pieces.size());
    require(place.vertex < file.pieces[place.piece].mesh.positions.size());
  }
}

void check(const Result<std::vector<head::PiecePoint>>& points,
           const std::vector<head::Piece>& pieces, std::size_t rows) {
  if (!points) return require(points.error().where.line > 0);
  require(points->size() == rows);
  for (const head::PiecePoint& point : *points) {
    require(point.piece < pieces.size());
    require(point.vertex < pieces[point.piece].mesh.positions.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(all.find('\0'), size);
  const auto file = head::read_obj(all.substr(0, end));
  if (!file) {
    require(!file.error().message.empty());
    return 0;
  }
  check(*file);
  const auto rows = head::read_points(all.substr(std::min(end + 1, size)));
  if (!rows) return 0;
  check(head::points_on(*file, *rows), file->pieces, rows->size());
  check(head::points_on(file->pieces, *rows), file->pieces, rows->size());
  return 0;
}
