// Any bytes as a list of points: rows or an error with its line, and each row is on a mesh or is
// not.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "fap/head/point_list.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;

std::vector<head::Piece> pieces() {
  std::vector<head::Piece> all(3);
  const char* names[] = {"face", "teeth", "Head"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].name = names[i];
    all[i].mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, float(i)}};
    all[i].mesh.triangles = {{0, 1, 2}};
  }
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<head::Piece> mesh = pieces();
  const auto rows = head::read_points({reinterpret_cast<const char*>(data), size});
  if (!rows) {
    require(!rows.error().message.empty());
    return 0;
  }
  require(!rows->empty());
  for (const head::PointRow& row : *rows) {
    require(row.line > 0 && (row.vertex || row.place));
    if (!row.place) continue;
    for (const float x : {row.place->x, row.place->y, row.place->z}) require(std::isfinite(x));
  }
  for (const head::PointRow& row : *rows) {
    const auto point = head::points_on(mesh, {row});
    if (!point) {
      require(point.error().where.line == row.line);
      continue;
    }
    require(point->size() == 1 && point->front().id == row.id);
    require(point->front().piece < mesh.size() && point->front().vertex < 3);
  }
  return 0;
}
