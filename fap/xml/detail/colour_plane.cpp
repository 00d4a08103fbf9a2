#include "fap/xml/detail/colour_plane.h"

#include <array>
#include <cmath>

#include "fap/head/srgb.h"

namespace animeme::head::detail {
namespace {

constexpr int kSide = 128;       // texels; Xface takes 512 at most
constexpr double kReach = 0.25;  // of the texture, from its middle to the outermost vertices
constexpr double kSameColour = 1 / 255.0;  // of a channel: colours that are nearer look the same

using Matrix = std::array<std::array<double, 3>, 3>;

// Turns a symmetric matrix until it is diagonal (Jacobi); the rows of the result are its axes.
Matrix axes_of(Matrix m) {
  Matrix axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int round = 0; round < 24; ++round) {
    for (const auto& [p, q] : {std::pair(0u, 1u), {0u, 2u}, {1u, 2u}}) {
      if (m[p][q] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1);
      const double s = t * c;
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b;
        m[k][q] = s * a + c * b;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b;
        m[q][k] = s * a + c * b;
        const double x = axes[p][k], y = axes[q][k];
        axes[p][k] = c * x - s * y;
        axes[q][k] = s * x + c * y;
      }
    }
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return m[a][a] > m[b][b]; });
  return {axes[order[0]], axes[order[1]], axes[order[2]]};
}

// A third of the triangles around each vertex, and a little for each, lest small things like
// pupils count for nothing.
std::vector<double> weights_of(const Mesh& mesh) {
  std::vector<double> weights(mesh.positions.size());
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]];
    const double area =
        double(length(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a))) / 6;
    for (const std::uint32_t v : t) weights[v] += area;
    sum += 3 * area;
  }
  const double least = sum > 0 ? 0.2 * sum / double(weights.size()) : 1;
  for (double& w : weights) w += least;
  return weights;
}

class Plane {
 public:
  explicit Plane(const Mesh& mesh) {
    for (const Vec3& c : mesh.colours) colours_.push_back(Vec3d(srgb_of_linear(c)));
    find_axes(weights_of(mesh));
    for (const Vec3d& c : colours_) {
      const Vec3d p = on_axes(c);
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), 0};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), 0};
    }
    half_ = {std::max(0.5 * (high_.x - low_.x), kSameColour),
             std::max(0.5 * (high_.y - low_.y), kSameColour), 0};
  }

  ColourPlane draw() const {
    ColourPlane out;
    const Vec3d centre = (low_ + high_) * 0.5;
    for (const Vec3d& c : colours_) {
      const Vec3d p = on_axes(c) - centre;
      out.places.push_back(
          {float(0.5 + kReach * p.x / half_.x), float(0.5 + kReach * p.y / half_.y)});
    }
    const std::vector<double> beside = beside_at(out.places);
    out.picture.width = out.picture.height = kSide;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const Vec3d p = centre + Vec3d{half_.x * away(x), half_.y * away(y),
                                       beside[std::size_t(y * kSide + x)]};
        const Vec3d c = mean_ + x_ * p.x + y_ * p.y + z_ * p.z;
        for (const double channel : {c.x, c.y, c.z}) {
          out.picture.rgb.push_back(std::uint8_t(std::lround(255 * std::clamp(channel, 0.0, 1.0))));
        }
      }
    }
    return out;
  }

 private:
  // The middle of a texel, in half extents of the colours.
  static double away(int texel) { return ((texel + 0.5) / kSide - 0.5) / kReach; }

  Vec3d on_axes(Vec3d c) const {
    c -= mean_;
    return {dot(c, x_), dot(c, y_), dot(c, z_)};
  }

  void find_axes(const std::vector<double>& weights) {
    double sum = 0;
    for (std::size_t v = 0; v < colours_.size(); ++v) {
      mean_ += colours_[v] * weights[v];
      sum += weights[v];
    }
    mean_ *= 1 / sum;
    Matrix spread = {};
    for (std::size_t v = 0; v < colours_.size(); ++v) {
      const Vec3d c = colours_[v] - mean_;
      const std::array<double, 3> x = {c.x, c.y, c.z};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) spread[i][j] += weights[v] / sum * x[i] * x[j];
      }
    }
    const Matrix axes = axes_of(spread);
    const auto row = [&](std::size_t i) { return Vec3d{axes[i][0], axes[i][1], axes[i][2]}; };
    x_ = row(0);
    y_ = row(1);
    z_ = row(2);
  }

  // For each texel how far the colours of the vertices there lie beside the plane: the mean of
  // those on it, else of those around it, from coarse to fine.
  std::vector<double> beside_at(const std::vector<TexturePlace>& places) const {
    std::vector<double> coarse = {0};
    for (int side = 2; side <= kSide; side *= 2) {
      const auto cell = [&](int x, int y) {
        return std::size_t(y) * std::size_t(side) + std::size_t(x);
      };
      std::vector<double> sums(cell(0, side)), counts(cell(0, side)), fine(cell(0, side));
      for (std::size_t v = 0; v < places.size(); ++v) {
        const std::size_t i = cell(int(places[v].u * float(side)), int(places[v].v * float(side)));
        sums[i] += on_axes(colours_[v]).z;
        ++counts[i];
      }
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          const double around =
              coarse[std::size_t(y / 2) * std::size_t(side / 2) + std::size_t(x / 2)];
          const std::size_t i = cell(x, y);
          fine[i] = counts[i] > 0 ? sums[i] / counts[i] : around;
        }
      }
      coarse = std::move(fine);
    }
    return coarse;
  }

  std::vector<Vec3d> colours_;  // sRGB
  Vec3d mean_, x_, y_, z_;      // x_ and y_ span the plane
  Vec3d low_, high_, half_;     // of the colours on it
};

}  // namespace

ColourPlane colour_plane(const Mesh& mesh) { return Plane(mesh).draw(); }

}  // namespace animeme::head::detail
