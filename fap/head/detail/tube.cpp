#include "fap/head/detail/tube.h"

#include <cmath>
#include <numbers>

namespace animeme::head::detail {

void join_rings(std::uint32_t base, std::size_t rows, int around, Mesh& mesh) {
  const auto at = [&](std::size_t row, int k) {
    return base + std::uint32_t(row) * std::uint32_t(around) + std::uint32_t(k % around);
  };
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    for (int k = 0; k < around; ++k) {
      mesh.triangles.push_back({at(row, k), at(row + 1, k), at(row + 1, k + 1)});
      mesh.triangles.push_back({at(row, k), at(row + 1, k + 1), at(row, k + 1)});
    }
  }
  const std::size_t last = rows - 1;
  for (int k = 1; k + 1 < around; ++k) {
    mesh.triangles.push_back({at(0, 0), at(0, k), at(0, k + 1)});
    mesh.triangles.push_back({at(last, 0), at(last, k + 1), at(last, k)});
  }
}

void add_tube(const std::vector<Section>& sections, int around, Mesh& mesh) {
  const auto base = std::uint32_t(mesh.positions.size());
  for (const Section& s : sections) {
    for (int k = 0; k < around; ++k) {
      const double a = 2 * std::numbers::pi * k / around;
      mesh.positions.push_back(Vec3(s.place + s.up * std::sin(a) + s.out * std::cos(a)));
    }
  }
  join_rings(base, sections.size(), around, mesh);
}

}  // namespace animeme::head::detail
