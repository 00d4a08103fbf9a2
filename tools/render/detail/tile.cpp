#include "tools/render/detail/tile.h"

#include <algorithm>
#include <cstring>

namespace animeme::render::detail {
namespace {

using head::Vec3;

// Samples of a pixel in subpixels: a turned square, no two in one row or column.
constexpr I4 kSampleX = {6, 14, 2, 10};
constexpr I4 kSampleY = {2, 6, 10, 14};

// Middle of the samples that a mask names, in pixels.
struct Middle {
  float x, y;
};
constexpr std::array<Middle, 16> make_middles() {
  std::array<Middle, 16> middles{};
  const int xs[] = {6, 14, 2, 10};
  const int ys[] = {2, 6, 10, 14};
  for (int mask = 1; mask < 16; ++mask) {
    int count = 0;
    int x = 0;
    int y = 0;
    for (int s = 0; s < 4; ++s) {
      if ((mask >> s & 1) == 0) continue;
      ++count;
      x += xs[s];
      y += ys[s];
    }
    middles[std::size_t(mask)] = {float(x) / float(16 * count), float(y) / float(16 * count)};
  }
  return middles;
}
constexpr std::array<Middle, 16> kMiddles = make_middles();

F4 splat(float v) { return F4{v, v, v, v}; }
I4 splat(std::int32_t v) { return I4{v, v, v, v}; }

F4 as_float(I4 v) {
  F4 f;
  std::memcpy(&f, &v, sizeof f);
  return f;
}
I4 as_int(F4 v) {
  I4 i;
  std::memcpy(&i, &v, sizeof i);
  return i;
}
F4 to_float(I4 v) { return __builtin_convertvector(v, F4); }

// One side of a triangle: value(x, y) >= 0 inside. Exact in integers, so neighbours share no
// sample and leave none out.
struct Side {
  std::int32_t step_x, step_y;
  std::int32_t start;
};

Side make_side(const ScreenVertex& p, const ScreenVertex& q, std::int32_t x0, std::int32_t y0) {
  const std::int32_t step_x = q.y - p.y;
  const std::int32_t step_y = p.x - q.x;
  std::int64_t start = std::int64_t(step_x) * (x0 - p.x) + std::int64_t(step_y) * (y0 - p.y);
  // A sample right on the side belongs to one of the two triangles.
  if (!(step_x > 0 || (step_x == 0 && step_y > 0))) start -= 1;
  constexpr std::int64_t kLarge = 1 << 30;  // no change of sign within a tile
  return {step_x, step_y, std::int32_t(std::clamp(start, -kLarge, kLarge))};
}

// value = at + dx * x + dy * y, pixels from the first corner.
struct Plane {
  float at, dx, dy;
  float operator()(float x, float y) const { return at + dx * x + dy * y; }
};

Vec3 unpack(std::uint32_t srgb) {
  return {float(srgb >> 16 & 255u), float(srgb >> 8 & 255u), float(srgb & 255u)};
}

std::int32_t pack(float r, float g, float b) {
  const auto byte = [](float v) { return std::int32_t(std::clamp(v, 0.0f, 255.0f) + 0.5f); };
  return byte(r) | byte(g) << 8 | byte(b) << 16;
}

}  // namespace

struct Tile::Planes {
  Plane red, green, blue;
  Plane normal_x, normal_y, normal_z;
};

void Tile::start(int x, int y, const RenderOptions& options) {
  x_ = x;
  y_ = y;
  width_ = std::min(kTile, options.width - x);
  height_ = std::min(kTile, options.height - y);
  nearness_.fill(splat(0.0f));
  const Vec3 top = unpack(options.background_top);
  const Vec3 bottom = unpack(options.background_bottom);
  for (int row = 0; row < kTile; ++row) {
    const Vec3 c = head::mix(top, bottom, (float(y + row) + 0.5f) / float(options.height));
    std::fill_n(colour_.begin() + row * kTile, kTile, splat(pack(c.x, c.y, c.z)));
  }
}

void Tile::draw(const Corners& corners, bool eye, const View& view) {
  const ScreenVertex& a = *corners.a;
  const ScreenVertex& b = *corners.b;
  const ScreenVertex& c = *corners.c;
  const auto first = [](std::int32_t low, int origin) { return std::max((low >> 4) - origin, 0); };
  const int x0 = first(std::min({a.x, b.x, c.x}), x_);
  const int y0 = first(std::min({a.y, b.y, c.y}), y_);
  const int x1 = std::min((std::max({a.x, b.x, c.x}) >> 4) - x_, width_ - 1);
  const int y1 = std::min((std::max({a.y, b.y, c.y}) >> 4) - y_, height_ - 1);
  if (x0 > x1 || y0 > y1) return;
  const std::int32_t left = (x_ + x0) * kSubpixels;
  const std::int32_t top = (y_ + y0) * kSubpixels;
  // On the screen, with y down, corners that were counterclockwise have a negative area.
  const Side sides[] = {make_side(a, b, left, top), make_side(b, c, left, top),
                        make_side(c, a, left, top)};
  const float bx = float(b.x - a.x) / kSubpixels;
  const float by = float(b.y - a.y) / kSubpixels;
  const float cx = float(c.x - a.x) / kSubpixels;
  const float cy = float(c.y - a.y) / kSubpixels;
  const float scale = 1 / (bx * cy - by * cx);
  const auto plane = [&](float va, float vb, float vc) {
    const float db = vb - va;
    const float dc = vc - va;
    return Plane{va, (db * cy - dc * by) * scale, (dc * bx - db * cx) * scale};
  };
  const Plane near = plane(a.nearness, b.nearness, c.nearness);
  Planes planes{plane(a.colour.x, b.colour.x, c.colour.x),
                plane(a.colour.y, b.colour.y, c.colour.y),
                plane(a.colour.z, b.colour.z, c.colour.z),
                {},
                {},
                {}};
  if (eye) {
    planes.normal_x = plane(a.normal.x, b.normal.x, c.normal.x);
    planes.normal_y = plane(a.normal.y, b.normal.y, c.normal.y);
    planes.normal_z = plane(a.normal.z, b.normal.z, c.normal.z);
  }
  I4 row_edge[3];
  for (int s = 0; s < 3; ++s) {
    row_edge[s] = sides[s].start + sides[s].step_x * kSampleX + sides[s].step_y * kSampleY;
  }
  const F4 sample_near = to_float(kSampleX) * splat(near.dx / kSubpixels) +
                         to_float(kSampleY) * splat(near.dy / kSubpixels);
  const float ax = float(a.x) / kSubpixels;
  const float ay = float(a.y) / kSubpixels;
  for (int y = y0; y <= y1; ++y) {
    I4 e0 = row_edge[0];
    I4 e1 = row_edge[1];
    I4 e2 = row_edge[2];
    const float py = float(y_ + y) - ay;
    for (int x = x0; x <= x1; ++x) {
      const I4 inside = (e0 | e1 | e2) >= 0;
      const float px = float(x_ + x) - ax;
      draw_pixel(y * kTile + x, inside, splat(near(px, py)) + sample_near, planes, px, py, eye,
                 view);
      e0 += sides[0].step_x * kSubpixels;
      e1 += sides[1].step_x * kSubpixels;
      e2 += sides[2].step_x * kSubpixels;
    }
    for (int s = 0; s < 3; ++s) row_edge[s] += sides[s].step_y * kSubpixels;
  }
}

inline void Tile::draw_pixel(int index, const I4& inside, const F4& nearness, const Planes& planes,
                             float x, float y, bool eye, const View& view) {
  F4& depth = nearness_[std::size_t(index)];
  const I4 seen = inside & (nearness > depth);
  const int mask = (seen[0] & 1) | (seen[1] & 2) | (seen[2] & 4) | (seen[3] & 8);
  if (mask == 0) return;
  depth = as_float((seen & as_int(nearness)) | (~seen & as_int(depth)));
  const Middle& m = kMiddles[std::size_t(mask)];
  const float mx = x + m.x;
  const float my = y + m.y;
  float light = 0;
  if (eye) {
    light = eye_highlight(
        {planes.normal_x(mx, my), planes.normal_y(mx, my), planes.normal_z(mx, my)}, view);
  }
  const I4 colour = splat(
      pack(planes.red(mx, my) + light, planes.green(mx, my) + light, planes.blue(mx, my) + light));
  I4& old = colour_[std::size_t(index)];
  old = (seen & colour) | (~seen & old);
}

void Tile::finish(Image& image) const {
  for (int y = 0; y < height_; ++y) {
    std::uint8_t* out =
        &image.rgba[(std::size_t(y_ + y) * std::size_t(image.width) + std::size_t(x_)) * 4];
    for (int x = 0; x < width_; ++x, out += 4) {
      const I4& c = colour_[std::size_t(y * kTile + x)];
      // Red and blue together: sums of four bytes do not run into each other.
      const auto sum = [&](int shift) {
        return (c[0] >> shift & 0xFF00FF) + (c[1] >> shift & 0xFF00FF) +
               (c[2] >> shift & 0xFF00FF) + (c[3] >> shift & 0xFF00FF) + 0x20002;
      };
      const std::int32_t rb = sum(0);
      const std::int32_t g = sum(8);
      out[0] = std::uint8_t(rb >> 2);
      out[1] = std::uint8_t(g >> 2);
      out[2] = std::uint8_t(rb >> 18);
      out[3] = 255;
    }
  }
}

}  // namespace animeme::render::detail
