#include "fap/head/vector.h"

namespace animeme::head {

Transform compose(const Transform& outer, const Transform& inner) {
  const Vec3 columns[] = {{inner.row_x.x, inner.row_y.x, inner.row_z.x},
                          {inner.row_x.y, inner.row_y.y, inner.row_z.y},
                          {inner.row_x.z, inner.row_y.z, inner.row_z.z}};
  const auto row = [&](Vec3 r) {
    return Vec3{dot(r, columns[0]), dot(r, columns[1]), dot(r, columns[2])};
  };
  return {row(outer.row_x), row(outer.row_y), row(outer.row_z), outer(inner.shift)};
}

Transform inverse(const Transform& t) {
  Transform back{{t.row_x.x, t.row_y.x, t.row_z.x},
                 {t.row_x.y, t.row_y.y, t.row_z.y},
                 {t.row_x.z, t.row_y.z, t.row_z.z},
                 {}};
  back.shift = back.turn(t.shift) * -1.0f;
  return back;
}

Transform rotation_about(Vec3 pivot, float pitch, float yaw, float roll) {
  const float cp = std::cos(pitch);
  const float sp = std::sin(pitch);
  const float cy = std::cos(yaw);
  const float sy = std::sin(yaw);
  const float cr = std::cos(roll);
  const float sr = std::sin(roll);
  const Transform about_z{{cr, -sr, 0}, {sr, cr, 0}, {0, 0, 1}, {}};
  const Transform about_x{{1, 0, 0}, {0, cp, -sp}, {0, sp, cp}, {}};
  const Transform about_y{{cy, 0, sy}, {0, 1, 0}, {-sy, 0, cy}, {}};
  Transform turn = compose(about_y, compose(about_x, about_z));
  turn.shift = pivot - turn.turn(pivot);
  return turn;
}

}  // namespace animeme::head
