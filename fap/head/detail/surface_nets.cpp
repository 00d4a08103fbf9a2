#include "fap/head/detail/surface_nets.h"

#include "fap/head/detail/distance.h"

namespace animeme::head::detail {
namespace {

constexpr std::uint32_t kNone = ~0u;

struct Grid {
  Vec3d low;
  double cell;
  int nx, ny, nz;  // corners
  std::vector<double> values;

  std::size_t index(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(ny) + std::size_t(y)) * std::size_t(nx) + std::size_t(x);
  }
  Vec3d place(int x, int y, int z) const { return low + Vec3d{x * cell, y * cell, z * cell}; }
};

Grid sample(const Field& field, Vec3d low, Vec3d high, double cell) {
  const auto corners = [cell](double a, double b) { return int((b - a) / cell + 0.5) + 1; };
  Grid g{low, cell, corners(low.x, high.x), corners(low.y, high.y), corners(low.z, high.z), {}};
  g.values.resize(std::size_t(g.nx) * std::size_t(g.ny) * std::size_t(g.nz));
  for (int z = 0; z < g.nz; ++z) {
    for (int y = 0; y < g.ny; ++y) {
      for (int x = 0; x < g.nx; ++x) g.values[g.index(x, y, z)] = field(g.place(x, y, z));
    }
  }
  return g;
}

// Mean of the points where the surface crosses the edges of a cell.
bool cell_vertex(const Grid& g, int x, int y, int z, Vec3d& vertex) {
  Vec3d sum;
  int count = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1;
    const int dy = corner >> 1 & 1;
    const int dz = corner >> 2;
    const double a = g.values[g.index(x + dx, y + dy, z + dz)];
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) continue;
      const int ex = dx + (axis == 0);
      const int ey = dy + (axis == 1);
      const int ez = dz + (axis == 2);
      const double b = g.values[g.index(x + ex, y + ey, z + ez)];
      if ((a < 0) == (b < 0)) continue;
      sum += mix(g.place(x + dx, y + dy, z + dz), g.place(x + ex, y + ey, z + ez), a / (a - b));
      ++count;
    }
  }
  if (count == 0) return false;
  vertex = sum * (1.0 / count);
  return true;
}

}  // namespace

Mesh surface_nets(const Field& field, Vec3d low, Vec3d high, double cell) {
  const Grid g = sample(field, low, high, cell);
  Mesh mesh;
  std::vector<std::uint32_t> ids(g.values.size(), kNone);
  for (int z = 0; z + 1 < g.nz; ++z) {
    for (int y = 0; y + 1 < g.ny; ++y) {
      for (int x = 0; x + 1 < g.nx; ++x) {
        Vec3d vertex;
        if (!cell_vertex(g, x, y, z, vertex)) continue;
        ids[g.index(x, y, z)] = std::uint32_t(mesh.positions.size());
        const Vec3d away = gradient(field, vertex, cell * 0.25);
        const double step = std::clamp(field(vertex), -cell * 0.4, cell * 0.4);
        mesh.positions.push_back(Vec3(vertex - away * step));
      }
    }
  }
  const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d, bool flip) {
    const std::uint32_t v[] = {ids[a], ids[b], ids[c], ids[d]};
    if (v[0] == kNone || v[1] == kNone || v[2] == kNone || v[3] == kNone) return;
    if (flip) {
      mesh.triangles.push_back({v[0], v[2], v[1]});
      mesh.triangles.push_back({v[0], v[3], v[2]});
    } else {
      mesh.triangles.push_back({v[0], v[1], v[2]});
      mesh.triangles.push_back({v[0], v[2], v[3]});
    }
  };
  for (int z = 1; z + 1 < g.nz; ++z) {
    for (int y = 1; y + 1 < g.ny; ++y) {
      for (int x = 1; x + 1 < g.nx; ++x) {
        const bool in = g.values[g.index(x, y, z)] < 0;
        if (in != (g.values[g.index(x + 1, y, z)] < 0)) {
          quad(g.index(x, y - 1, z - 1), g.index(x, y, z - 1), g.index(x, y, z),
               g.index(x, y - 1, z), !in);
        }
        if (in != (g.values[g.index(x, y + 1, z)] < 0)) {
          quad(g.index(x - 1, y, z - 1), g.index(x - 1, y, z), g.index(x, y, z),
               g.index(x, y, z - 1), !in);
        }
        if (in != (g.values[g.index(x, y, z + 1)] < 0)) {
          quad(g.index(x - 1, y - 1, z), g.index(x, y - 1, z), g.index(x, y, z),
               g.index(x - 1, y, z), !in);
        }
      }
    }
  }
  return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto base = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  mesh.colours.insert(mesh.colours.end(), other.colours.begin(), other.colours.end());
  mesh.occlusion.insert(mesh.occlusion.end(), other.occlusion.begin(), other.occlusion.end());
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

void append_mirrored(Mesh& mesh, std::size_t first_vertex, std::size_t first_triangle) {
  const std::size_t vertices = mesh.positions.size();
  const std::size_t triangles = mesh.triangles.size();
  const auto shift = std::uint32_t(vertices - first_vertex);
  for (std::size_t i = first_vertex; i < vertices; ++i) {
    const Vec3 p = mesh.positions[i];
    mesh.positions.push_back({-p.x, p.y, p.z});
    if (i < mesh.colours.size()) mesh.colours.push_back(Vec3(mesh.colours[i]));
    if (i < mesh.occlusion.size()) mesh.occlusion.push_back(float(mesh.occlusion[i]));
  }
  for (std::size_t i = first_triangle; i < triangles; ++i) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back({t[0] + shift, t[2] + shift, t[1] + shift});
  }
}

}  // namespace animeme::head::detail
