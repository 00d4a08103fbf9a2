// Sides of triangles in integers, four samples at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "tools/view/render/detail/shade.h"

namespace animeme::render::detail {

/// Vectors of the four samples of a pixel.
using F4 = Float4;
using I4 = Int4;

inline F4 splat(float v) { return F4{v, v, v, v}; }
inline I4 splat(std::int32_t v) { return I4{v, v, v, v}; }

inline F4 as_float(I4 v) {
  F4 f;
  std::memcpy(&f, &v, sizeof f);
  return f;
}
inline I4 as_int(F4 v) {
  I4 i;
  std::memcpy(&i, &v, sizeof i);
  return i;
}
/// Bit k: lane k is set.
inline int lanes(I4 v) {
#ifdef __SSE__
  return __builtin_ia32_movmskps(as_float(v));
#else
  return (v[0] & 1) | (v[1] & 2) | (v[2] & 4) | (v[3] & 8);
#endif
}
inline F4 to_float(I4 v) { return __builtin_convertvector(v, F4); }

/// One side of a triangle: value(x, y) >= 0 inside. Exact in integers, so neighbours share no
/// sample and leave none out.
struct Side {
  std::int32_t step_x, step_y;
  std::int32_t start;
};

inline Side make_side(const ScreenVertex& p, const ScreenVertex& q, std::int32_t x0,
                      std::int32_t y0) {
  const std::int32_t step_x = q.y - p.y;
  const std::int32_t step_y = p.x - q.x;
  std::int64_t start = std::int64_t(step_x) * (x0 - p.x) + std::int64_t(step_y) * (y0 - p.y);
  // A sample right on the side belongs to one of the two triangles.
  if (!(step_x > 0 || (step_x == 0 && step_y > 0))) start -= 1;
  constexpr std::int64_t kLarge = 1 << 30;  // no change of sign within a tile
  return {step_x, step_y, std::int32_t(std::clamp(start, -kLarge, kLarge))};
}

/// Which pixels of a row can have a sample inside of all sides. Careful by a pixel, as it reckons
/// in floating point; the samples are decided by the sides themselves.
class Reach {
 public:
  struct Span {
    int first, last;  // from the first pixel of the row
  };

  Reach() = default;
  explicit Reach(const Side (&sides)[3]) {
    for (int s = 0; s < 3; ++s) {
      const std::int32_t step = sides[s].step_x * kSubpixels;
      scale_[s] = step == 0 ? 0 : -1 / float(step);
      rises_[s] = step > 0;
    }
  }

  Span of(const I4 (&edges)[3], int last) const {
    float from = 0;
    float to = float(last);
    for (int s = 0; s < 3; ++s) {
      // The sample that is farthest in.
      const std::int32_t most =
          std::max(std::max(edges[s][0], edges[s][1]), std::max(edges[s][2], edges[s][3]));
      const float border = float(most) * scale_[s];  // here it would be on the side
      if (scale_[s] == 0) {
        if (most < 0) to = -1;
      } else if (rises_[s]) {
        from = std::max(from, border - 1);
      } else {
        to = std::min(to, border + 1);
      }
    }
    return {int(from), int(std::max(to, -1.0f))};
  }

 private:
  float scale_[3] = {};
  bool rises_[3] = {};
};

}  // namespace animeme::render::detail
