#include "fap/head/detail/grid.h"

#include <array>
#include <numbers>

namespace animeme::head::detail {
namespace {

using std::numbers::pi;

// How the rays of a row start and rise.
struct RowKey {
  int row;
  double y;         // origin
  double z;         // origin
  double rise;      // angle above the horizon, rad
  double ease = 1;  // rows behind this key: t becomes t^ease
};

using Keys = std::array<RowKey, 14>;

struct Columns {
  std::vector<double> eye_x;    // at the height of the eyes, up to eye_outer
  std::vector<double> mouth_x;  // at the height of the mouth, up to mouth_corner
  std::vector<double> angle;    // azimuth at the height of the eyes
  std::vector<double> shift;    // added at the height of the mouth
};

Columns make_columns(const Shape& shape, const Layout& l) {
  Columns c;
  const double inner = shape.inner_corner();
  for (int i = 0; i <= l.eye_outer; ++i) {
    const double x = i <= l.eye_inner ? inner * i / l.eye_inner
                                      : inner + shape.p.eye_width * (i - l.eye_inner) /
                                                    double(l.eye_outer - l.eye_inner);
    c.eye_x.push_back(x);
    c.angle.push_back(std::atan2(x, shape.front(x, 0.2).z));
  }
  const double step = c.angle[std::size_t(l.eye_outer)] - c.angle[std::size_t(l.eye_outer - 1)];
  const double start = c.angle.back();
  const int rest = l.back - l.eye_outer;
  const double a = std::max(step * rest / (pi - start), 0.3);
  for (int i = 1; i <= rest; ++i) {
    const double t = double(i) / rest;
    c.angle.push_back(start + (pi - start) * (a * t + (1 - a) * t * t));
  }
  double last = 0;
  for (int i = 0; i < l.columns(); ++i) {
    if (i <= l.mouth_corner) {
      const double x = shape.p.mouth_width * i / l.mouth_corner;
      c.mouth_x.push_back(x);
      last = std::atan2(x, shape.front(x, shape.lip_line(x)).z) - c.angle[std::size_t(i)];
      c.shift.push_back(last);
    } else {
      c.shift.push_back(last * smooth_step(double(l.back), double(l.mouth_corner), double(i)));
    }
  }
  return c;
}

Keys make_keys(const Shape& shape, const Layout& l, const Columns& columns, int i) {
  const HeadParameters& p = shape.p;
  const double at_eye = i <= l.eye_outer ? columns.eye_x[std::size_t(i)] : shape.outer_corner();
  const bool eye = l.in_eye(i);
  const double upper =
      eye ? shape.upper_lid(at_eye)
          : shape.upper_lid(i < l.eye_inner ? shape.inner_corner() : shape.outer_corner());
  const double lower = eye ? shape.lower_lid(at_eye) : upper;
  const double beyond = std::max(i - l.mouth_corner, 0) / double(l.mouth_corner);
  const double at_mouth =
      p.mouth_width * (i <= l.mouth_corner ? double(i) / l.mouth_corner : 1 + beyond);
  const double line = shape.lip_line(at_mouth);
  const double spread = 1.0 * std::min(std::pow(beyond, 1.2), 1.1);
  const double side = columns.angle[std::size_t(i)] / pi;  // 0 front, 1 back
  // Under the chin rays point down; at the sides and behind there is only the neck.
  const double behind = smooth_step(0.12, 0.42, side);
  const double chin = -p.chin_drop + 0.5;
  const double throat = -p.chin_drop - 2.8;
  const double jaw = -p.chin_drop + 3.4;
  Keys keys = {{{0, 2.0, 0, pi / 2},
                {l.hairline, 2.0, 0, 0.80},
                {l.brow, p.brow_height, 0, 0, 0.8},
                {l.upper_lid, upper, 0, 0},
                {l.lower_lid, lower, 0, 0, 1.25},
                {l.nose_base, shape.nose_base(), 0, 0},
                {l.upper_lip, shape.upper_lip(at_mouth) + spread, 0, 0},
                {l.upper_contact, line, 0, 0},
                {l.lower_contact, line, 0, 0},
                {l.lower_lip, shape.lower_lip(at_mouth) - spread, 0, 0},
                {l.chin, chin, 0, 0},
                {l.under_chin, jaw + (0.5 * (chin + throat) - jaw) * behind, 1.0 - 1.8 * behind,
                 -1.12 * (1 - behind)},
                {l.throat, throat, -1.6, 0},
                {l.bottom, std::min(-17.2, -p.chin_drop - 7.6), -3.0, 0}}};
  // Rows do not pass each other, whatever the sizes are.
  for (std::size_t k = 3; k + 3 < keys.size(); ++k) {
    if (keys[k].row == l.lower_lid || keys[k].row == l.lower_contact) continue;
    const double least = 0.012 * (keys[k].row - keys[k - 1].row);
    keys[k].y = std::min(keys[k].y, keys[k - 1].y - least);
  }
  return keys;
}

Vec3d cast(const Shape& shape, const Columns& columns, const Layout& l, const Keys& keys, int row,
           int i) {
  std::size_t k = 0;
  while (k + 2 < keys.size() && row >= keys[k + 1].row) ++k;
  const RowKey& a = keys[k];
  const RowKey& b = keys[k + 1];
  const double t = std::pow(double(row - a.row) / (b.row - a.row), a.ease);
  const double y = a.y + (b.y - a.y) * t;
  const double rise = a.rise + (b.rise - a.rise) * t;
  const double at_mouth = smooth_step(double(l.lower_lid), double(l.upper_lip), double(row)) *
                          smooth_step(double(l.throat), double(l.lower_lip), double(row));
  const double angle = columns.angle[std::size_t(i)] + at_mouth * columns.shift[std::size_t(i)];
  const Vec3d direction{std::sin(angle) * std::cos(rise), std::sin(rise),
                        std::cos(angle) * std::cos(rise)};
  const Vec3d origin{0, y, a.z + (b.z - a.z) * t};
  Vec3d hit = outer_hit(shape.skin, origin, direction, 18);
  if (i == 0 || i == l.back || row == 0) hit.x = 0;
  return hit;
}

bool pinned(const Layout& l, int row, int i) {
  if (row == 0 || row == l.bottom) return true;
  if (i >= l.eye_inner - 1 && i <= l.eye_outer + 1 && row >= l.upper_lid - 5 &&
      row <= l.lower_lid + 4) {
    return true;
  }
  return i <= l.mouth_corner + 1 && row >= l.upper_lip && row <= l.lower_lip;
}

// Rows near slits stand exactly over their x.
void pin_slits(const Shape& shape, const Layout& l, const Columns& columns,
               std::vector<Vec3d>& grid) {
  for (int row = 0; row < l.rows(); ++row) {
    for (int i = 0; i < l.columns(); ++i) {
      if (!pinned(l, row, i) || row == 0 || row == l.bottom) continue;
      Vec3d& place = grid[std::size_t(row * l.columns() + i)];
      if (row < l.nose_base && i <= l.eye_outer) {
        place = shape.front(columns.eye_x[std::size_t(i)], place.y);
      } else if (row > l.nose_base && i <= l.mouth_corner) {
        place = shape.front(columns.mouth_x[std::size_t(i)], place.y);
      }
    }
  }
}

// Evens the grid out: free places move to the middle of their neighbours, then to the surface.
void relax(const Shape& shape, const Layout& l, std::vector<Vec3d>& grid, int rounds) {
  const int n = l.columns();
  std::vector<Vec3d> next(grid);
  for (int round = 0; round < rounds; ++round) {
    for (int row = 1; row < l.bottom; ++row) {
      for (int i = 0; i < n; ++i) {
        if (pinned(l, row, i)) continue;
        const auto at = [&](int r, int c) { return grid[std::size_t(r * n + c)]; };
        Vec3d left = at(row, std::max(i - 1, i == 0 ? 1 : 0));
        Vec3d right = at(row, i == l.back ? l.back - 1 : i + 1);
        if (i == 0) left.x = -left.x;
        if (i == l.back) right.x = -right.x;
        const Vec3d middle = (left + right + at(row - 1, i) + at(row + 1, i)) * 0.25;
        Vec3d moved = project(shape.skin, mix(at(row, i), middle, 0.6), 1);
        if (i == 0 || i == l.back) moved.x = 0;
        next[std::size_t(row * n + i)] = moved;
      }
    }
    grid.swap(next);
    next = grid;
  }
}

}  // namespace

Layout::Layout(double density) {
  const auto rows_of = [density](int count) { return std::max(int(count * density + 0.5), 2); };
  mouth_corner = rows_of(20);
  eye_inner = rows_of(12);
  eye_outer = eye_inner + rows_of(24);
  back = eye_outer + rows_of(34);
  hairline = rows_of(10);
  brow = hairline + rows_of(12);
  upper_lid = brow + rows_of(19);
  lower_lid = upper_lid + 1;
  nose_base = lower_lid + rows_of(24);
  upper_lip = nose_base + rows_of(7);
  upper_contact = upper_lip + rows_of(9);
  lower_contact = upper_contact + 1;
  lower_lip = lower_contact + rows_of(10);
  chin = lower_lip + rows_of(13);
  under_chin = chin + rows_of(9);
  throat = under_chin + rows_of(7);
  bottom = throat + rows_of(9);
}

std::vector<Vec3d> lay_out(const Shape& shape, const Layout& layout) {
  const Columns columns = make_columns(shape, layout);
  std::vector<Vec3d> grid(std::size_t(layout.rows() * layout.columns()));
  for (int i = 0; i < layout.columns(); ++i) {
    const Keys keys = make_keys(shape, layout, columns, i);
    for (int row = 0; row < layout.rows(); ++row) {
      grid[std::size_t(row * layout.columns() + i)] = cast(shape, columns, layout, keys, row, i);
    }
  }
  pin_slits(shape, layout, columns, grid);
  relax(shape, layout, grid, 14);
  return grid;
}

}  // namespace animeme::head::detail
