#include "fap/head/detail/scalp.h"

#include <numbers>

#include "fap/head/detail/tube.h"

namespace animeme::head::detail {
namespace {

using std::numbers::pi;
constexpr Vec3d kMiddle{0, 3.2, -0.6};
constexpr int kCapRows = 24;
constexpr int kLockAround = 5;

// Half width of a lock along its length, 0..1.
double profile(double t) {
  return (0.35 + 0.65 * smooth_step(0.0, 0.3, t)) *
         std::pow(std::max(1 - std::pow(t, 4.0), 0.0), 0.62);
}

}  // namespace

Scalp::Scalp(const Shape& shape, double tilt)
    : shape_(shape),
      crown_{0, std::cos(tilt), -std::sin(tilt)},
      front_{0, std::sin(tilt), std::cos(tilt)} {}

Vec3d Scalp::direction(double theta, double phi) const {
  const Vec3d around = front_ * std::cos(phi) + Vec3d{1, 0, 0} * std::sin(phi);
  return crown_ * std::cos(theta) + around * std::sin(theta);
}

Vec3d Scalp::place(double theta, double phi, double height) const {
  const Vec3d away = direction(theta, phi);
  const Vec3d skin = outer_hit(shape_.skin, kMiddle, away, 16);
  if (height == 0) return skin;
  return skin + normalised(away + gradient(shape_.skin, skin, 0.5)) * height;
}

double Scalp::edge(double phi, const std::function<double(Vec3d)>& height) const {
  double theta = 0.5;
  double step = 0.05;
  while (step > 1e-3 && theta < 2.6) {
    const Vec3d p = place(theta + step, phi, 0);
    if (p.y > height(p)) {
      theta += step;
    } else {
      step *= 0.5;
    }
  }
  return theta;
}

void add_cap(const Scalp& scalp, const std::vector<double>& edges, const Thickness& thickness,
             Vec3 colour, Mesh& mesh) {
  const auto base = std::uint32_t(mesh.positions.size());
  const auto columns = std::uint32_t(edges.size());
  mesh.positions.push_back(Vec3(scalp.place(0, 0, thickness(1, 0))));
  // Two more rows tuck the edge in, below the skin.
  const auto rows = std::uint32_t(kCapRows + 2);
  for (std::uint32_t row = 1; row <= rows; ++row) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double phi = 2 * pi * c / columns;
      const double t = std::min(double(row) / kCapRows, 1.0);
      const double eased = t * (1.25 - 0.25 * t);  // rows are closer at the edge
      const double grown = thickness(1 - eased, phi);
      const double height = row == rows ? -0.35 : row > kCapRows ? -0.05 : grown;
      mesh.positions.push_back(Vec3(scalp.place(eased * edges[c], phi, height)));
    }
  }
  mesh.positions.push_back(Vec3(kMiddle));
  while (mesh.colours.size() < mesh.positions.size()) {
    const double phi = double((mesh.colours.size() - base + columns - 1) % columns) / columns;
    const double streak = 0.6 * std::sin(phi * 2 * pi * 23) + 0.4 * std::sin(phi * 2 * pi * 41);
    mesh.colours.push_back(colour * float(0.95 + 0.2 * streak));
  }
  mesh.occlusion.resize(mesh.positions.size(), 1.0f);
  const auto at = [&](std::uint32_t row, std::uint32_t c) {
    return base + 1 + (row - 1) * columns + c % columns;
  };
  const auto last = std::uint32_t(mesh.positions.size() - 1);
  for (std::uint32_t c = 0; c < columns; ++c) {
    mesh.triangles.push_back({base, at(1, c), at(1, c + 1)});
    for (std::uint32_t row = 1; row < rows; ++row) {
      mesh.triangles.push_back({at(row, c), at(row + 1, c), at(row + 1, c + 1)});
      mesh.triangles.push_back({at(row, c), at(row + 1, c + 1), at(row, c + 1)});
    }
    mesh.triangles.push_back({at(rows, c), last, at(rows, c + 1)});
  }
}

double scattered(int i) { return double((std::uint32_t(i) * 2654435761u) >> 16 & 1023u) / 1023; }

void add_lock(const Lock& lock, Vec3 colour, Mesh& mesh) {
  std::vector<Section> sections;
  const std::size_t n = lock.places.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d along =
        normalised(lock.places[std::min(i + 1, n - 1)] - lock.places[i == 0 ? 0 : i - 1]);
    const Vec3d side = normalised(cross(lock.outwards[i], along));
    const Vec3d out = cross(along, side);
    const double half = lock.width * std::max(profile(double(i) / double(n - 1)), 0.03);
    sections.push_back({lock.places[i], side * half, out * (half * lock.flatness)});
  }
  add_tube(sections, kLockAround, mesh);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = double(i) / double(n - 1);
    for (int k = 0; k < kLockAround; ++k) {
      const double up = std::cos(2 * pi * k / kLockAround);  // 1 on the outer side
      const double streak = 0.5 + 0.5 * std::sin(k * 2.4 + lock.tint * 37);
      const double light = 0.78 + 0.22 * std::sin(pi * std::min(t * 1.15, 1.0)) + 0.28 * streak;
      mesh.colours.push_back(colour * float(light * lock.tint));
      mesh.occlusion.push_back(float(0.72 + 0.28 * up) * float(0.8 + 0.2 * t));
    }
  }
}

}  // namespace animeme::head::detail
