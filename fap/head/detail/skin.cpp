// From the laid out half to the closed mesh of the skin: lips, lids, pockets, colours.
#include <numbers>

#include "fap/head/detail/grid.h"
#include "fap/head/detail/paint.h"

namespace animeme::head::detail {
namespace {

// Lips: the surface between contour and contact line bulges and rolls in.
void form_lips(const Shape& shape, const Layout& l, std::vector<Vec3d>& grid) {
  const int n = l.columns();
  for (int i = 0; i <= l.mouth_corner; ++i) {
    const double x = grid[std::size_t(l.upper_contact * n + i)].x;
    const double body = shape.lip_body(x) * shape.p.lip_fullness;
    const Vec3d line = shape.front(x, shape.lip_line(x));
    const Vec3d out = normalised(gradient(shape.skin, line, 0.3) * Vec3d{0.8, 0, 1});
    for (const bool upper : {true, false}) {
      const int contour = upper ? l.upper_lip : l.lower_lip;
      const int contact = upper ? l.upper_contact : l.lower_contact;
      const int count = std::abs(contact - contour);
      const double edge = upper ? shape.upper_lip(x) : shape.lower_lip(x);
      for (int k = 0; k <= count; ++k) {
        const int row = contour + (contact > contour ? k : -k);
        const double r = double(k) / count;
        const double y = edge + (shape.lip_line(x) - edge) * (1 - std::pow(1 - r, 1.45));
        const double tuck = smooth_step(0.55, 1.0, r);
        const double bulge = upper ? 0.40 : 0.46;
        const double swell = std::sin(std::numbers::pi * 0.5 * std::min(r / 0.66, 1.0));
        // Both lips come to the same line.
        const double height = body * (bulge * swell - (bulge - 0.16) * tuck * tuck) - 0.06 * tuck;
        grid[std::size_t(row * n + i)] = shape.front(x, y) + out * height;
      }
    }
  }
}

// Lids lie on a ball around the eye, with a crease above the upper one.
void form_lids(const Shape& shape, const Layout& l, std::vector<Vec3d>& grid) {
  const int n = l.columns();
  const int reach = 5;
  for (int i = l.eye_inner - 1; i <= l.eye_outer + 1; ++i) {
    for (int row = l.upper_lid - 3 * reach; row <= l.lower_lid + reach; ++row) {
      Vec3d& place = grid[std::size_t(row * n + i)];
      const int from_rim = row <= l.upper_lid ? l.upper_lid - row : row - l.lower_lid;
      const Vec3d away = normalised(place - shape.eye);
      const double on_ball = smooth_step(double(reach), 1.0, double(from_rim));
      if (l.in_eye(i)) {
        const Vec3d d = place - shape.eye;
        const double square = shape.lid * shape.lid - d.x * d.x - d.y * d.y;
        place.z += on_ball * (shape.eye.z + std::sqrt(std::max(square, 0.01)) - place.z);
      }
      if (row >= l.upper_lid) continue;
      const double d = place.y - shape.crease(place.x);
      const double q = (place.x - shape.eye.x) / (shape.p.eye_width / 2);
      const double fade = smooth_step(1.0, 0.45, std::abs(q));
      const double fold = -0.10 * std::exp(-std::pow(d / 0.13, 2)) +
                          0.08 * std::exp(-std::pow((d - 0.30) / 0.22, 2));
      place += away * (fold * fade);
    }
  }
}

void connect_rows(const Layout& l, const Skin& skin, int row, std::vector<Triangle>& out) {
  for (int c = -l.back; c < l.back; ++c) {
    const int half = c >= 0 ? c : -c - 1;  // the column nearer to the front
    if (row == l.upper_lid && half >= l.eye_inner && half < l.eye_outer) continue;
    if (row == l.upper_contact && half < l.mouth_corner) continue;
    if (row == l.upper_lid || row == l.upper_contact) continue;  // both rows are one there
    const std::uint32_t a = skin.at(row, c);
    const std::uint32_t b = skin.at(row, c + 1);
    const std::uint32_t d = skin.at(row + 1, c);
    const std::uint32_t e = skin.at(row + 1, c + 1);
    if (row == 0) {
      out.push_back({a, d, e});
    } else if (c >= 0) {
      out.push_back({a, d, e});
      out.push_back({a, e, b});
    } else {
      out.push_back({a, d, b});
      out.push_back({b, d, e});
    }
  }
}

bool shared_with_row_above(const Layout& l, int row, int column) {
  const int half = std::abs(column);
  if (row == l.lower_lid) return half <= l.eye_inner || half >= l.eye_outer;
  if (row == l.lower_contact) return half >= l.mouth_corner;
  return false;
}

void number_vertices(const std::vector<Vec3d>& grid, Skin& skin) {
  const Layout& l = skin.layout;
  const int around = 2 * l.back;
  skin.ids.assign(std::size_t(l.rows() * around), 0);
  for (int row = 0; row < l.rows(); ++row) {
    for (int k = 0; k < around; ++k) {
      const int column = k <= l.back ? k : k - around;
      std::uint32_t& id = skin.ids[std::size_t(row * around + k)];
      if (row == 0 && k > 0) {
        id = skin.ids[0];
      } else if (shared_with_row_above(l, row, column)) {
        id = skin.at(row - 1, column);
      } else {
        Vec3d place = grid[std::size_t(row * l.columns() + std::abs(column))];
        if (column < 0) place.x = -place.x;
        id = std::uint32_t(skin.places.size());
        skin.places.push_back(place);
      }
    }
  }
}

void close_bottom(Skin& skin) {
  const Layout& l = skin.layout;
  const auto centre = std::uint32_t(skin.places.size());
  Vec3d middle;
  for (int c = -l.back; c < l.back; ++c) middle += skin.places[skin.at(l.bottom, c)];
  middle *= 1.0 / (2 * l.back);
  middle.x = 0;
  skin.places.push_back(middle);
  for (int c = -l.back; c < l.back; ++c) {
    skin.mesh.triangles.push_back({skin.at(l.bottom, c), centre, skin.at(l.bottom, c + 1)});
  }
}

}  // namespace

std::uint32_t Skin::at(int row, int column) const {
  const int around = 2 * layout.back;
  return ids[std::size_t(row * around + (column % around + around) % around)];
}

Skin make_skin(const Shape& shape, double density) {
  Skin skin{Layout(density), {}, {}, {}, {}};
  std::vector<Vec3d> grid = lay_out(shape, skin.layout);
  form_lips(shape, skin.layout, grid);
  form_lids(shape, skin.layout, grid);
  if (shape.p.lines > 0) {
    for (Vec3d& place : grid) {
      const double depth = age_line(shape.p, place);
      if (depth > 1e-3) place -= normalised(gradient(shape.skin, place, 0.2)) * (0.12 * depth);
    }
  }
  number_vertices(grid, skin);
  for (int row = 0; row < skin.layout.bottom; ++row) {
    connect_rows(skin.layout, skin, row, skin.mesh.triangles);
  }
  close_bottom(skin);
  add_mouth_bag(shape, skin);
  add_eye_pocket(shape, skin, 1);
  add_eye_pocket(shape, skin, -1);
  for (const Vec3d& place : skin.places) skin.mesh.positions.push_back(Vec3(place));
  skin.mesh.surface = SurfaceKind::skin;
  paint_skin(shape, skin);
  return skin;
}

}  // namespace animeme::head::detail
