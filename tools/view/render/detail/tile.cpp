#include "tools/view/render/detail/tile.h"

#include <algorithm>
#include <cmath>

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

constexpr int kWide = 7;        // pixels
constexpr int kLookEvery = 48;  // triangles

constexpr float kOpaque = 255;

F4 as_vector(Vec3 v) { return F4{v.x, v.y, v.z, kOpaque}; }

Vec3 unpack(std::uint32_t srgb) {
  return {float(srgb >> 16 & 255u), float(srgb >> 8 & 255u), float(srgb & 255u)};
}

// 0xAABBGGRR of red, green, blue and alpha.
inline std::int32_t pack(F4 colour) {
  const F4 high = splat(255.0f);
  const I4 over = colour > high;
  const I4 positive = colour > splat(0.0f);
  colour = as_float(((over & as_int(high)) | (~over & as_int(colour))) & positive);
  const I4 bytes = __builtin_convertvector(colour + splat(0.5f), I4);
  return std::int32_t(std::uint32_t(bytes[0] | bytes[1] << 8 | bytes[2] << 16) |
                      std::uint32_t(bytes[3]) << 24);
}

// `shown` over what four samples have.
I4 mixed(const I4& old, F4 shown, float share) {
  I4 out{};
  for (int s = 0; s < 4; ++s) {
    const F4 below = {float(old[s] & 255), float(old[s] >> 8 & 255), float(old[s] >> 16 & 255),
                      float(old[s] >> 24 & 255)};
    out[s] = pack(below + (shown - below) * splat(share));
  }
  return out;
}

}  // namespace

// value = at + dx * x + dy * y, pixels from the first corner; four values at once.
struct Tile::Plane {
  F4 at, dx, dy;
  F4 operator()(float x, float y) const { return at + dx * splat(x) + dy * splat(y); }
};

Tile::Plane Tile::plane(const ScreenFrame& frame, F4 a, F4 b, F4 c) {
  const F4 db = b - a;
  const F4 dc = c - a;
  return {a, (db * splat(frame.cy) - dc * splat(frame.by)) * splat(frame.scale),
          (dc * splat(frame.bx) - db * splat(frame.cx)) * splat(frame.scale)};
}

// What a triangle without a material shows; made when the first of its pixels is seen.
struct Tile::Planes {
  const Corners& corners;
  const ScreenFrame& frame;
  bool eye;
  const View& view;
  bool ready = false;
  float strength = 0;  // of the grain
  bool lines = false;
  Plane colour{};
  Plane normal{};  // or the place in the grain

  static constexpr bool kDraws = true;
  static constexpr bool over() { return false; }
  static constexpr bool blends() { return false; }

  void make() {
    const ScreenVertex& a = *corners.a;
    const ScreenVertex& b = *corners.b;
    const ScreenVertex& c = *corners.c;
    colour = plane(frame, as_vector(a.colour), as_vector(b.colour), as_vector(c.colour));
    if (eye) {
      normal = plane(frame, as_vector(a.normal), as_vector(b.normal), as_vector(c.normal));
    }
    // Its strength changes little within a triangle.
    const float mean = (a.grain + b.grain + c.grain) / 3;
    constexpr float kLeast = 0.004f;  // less than a step of a colour
    lines = mean < 0;
    strength = std::abs(mean) > kLeast ? std::abs(mean) : 0;
    if (strength > 0)
      normal = plane(frame, as_vector(a.normal), as_vector(b.normal), as_vector(c.normal));
    ready = true;
  }

  float paint(float x, float y, F4& shown) {
    if (!ready) make();
    shown = colour(x, y);
    if (eye) {
      const F4 n = normal(x, y);
      const head::Vec3 facing = normalised(head::Vec3{n[0], n[1], n[2]});
      shown = shown * splat(lid_shadow(facing)) + splat(eye_highlight(facing, view));
    }
    if (strength > 0) shown = shown * splat(1 + strength * view.grain->at(normal(x, y), lines));
    return 1;
  }
};

void Tile::start(int x, int y, const RenderOptions& options) {
  x_ = x;
  y_ = y;
  width_ = std::min(kTile, options.width - x);
  height_ = std::min(kTile, options.height - y);
  nearness_.fill(splat(0.0f));
  farthest_.fill(0);
  drawn_ = 0;
  const Image* behind = options.background.get();
  if (options.transparent) {
    colour_.fill(splat(0));
    return;
  }
  if (behind != nullptr && behind->width == options.width && behind->height == options.height) {
    show_behind(*behind);
    return;
  }
  const Vec3 top = unpack(options.background_top);
  const Vec3 bottom = unpack(options.background_bottom);
  for (int row = 0; row < kTile; ++row) {
    const Vec3 c = head::mix(top, bottom, (float(y + row) + 0.5f) / float(options.height));
    std::fill_n(colour_.begin() + row * kTile, kTile, splat(pack(as_vector(c))));
  }
}

void Tile::show_behind(const Image& picture) {
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* pixel =
        &picture.rgba[(std::size_t(y_ + y) * std::size_t(picture.width) + std::size_t(x_)) * 4];
    for (int x = 0; x < width_; ++x, pixel += 4) {
      const F4 colour = {float(pixel[0]), float(pixel[1]), float(pixel[2]), kOpaque};
      colour_[std::size_t(y * kTile + x)] = splat(pack(colour));
    }
  }
}

void Tile::look_how_near() {
  drawn_ = 0;
  for (int block = 0; block < kBlocks * kBlocks; ++block) {
    const int first = block / kBlocks * kBlock * kTile + block % kBlocks * kBlock;
    F4 least = nearness_[std::size_t(first)];
    for (int y = 0; y < kBlock; ++y) {
      for (int x = 0; x < kBlock; ++x) {
        const F4 here = nearness_[std::size_t(first + y * kTile + x)];
        least = here < least ? here : least;
      }
    }
    farthest_[std::size_t(block)] =
        std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
  }
}

bool Tile::is_hidden(float nearest, int x0, int y0, int x1, int y1) const {
  for (int y = y0 / kBlock; y <= y1 / kBlock; ++y) {
    for (int x = x0 / kBlock; x <= x1 / kBlock; ++x) {
      if (nearest > farthest_[std::size_t(y * kBlocks + x)]) return false;
    }
  }
  return true;
}

void Tile::draw(const Corners& corners, bool eye, const View& view) {
  Box box;
  if (!find_box(corners, box)) return;
  const ScreenFrame frame(corners);
  Planes planes{corners, frame, eye, view};
  fill(corners, frame, box, planes);
}

// Depth alone.
struct Tile::Cover {
  static constexpr bool kDraws = false;
  static constexpr bool over() { return false; }
};

void Tile::cover(const MaterialFacet& facet) {
  Cover cover;
  Box box;
  if (find_box(facet.screen, box)) fill(facet.screen, ScreenFrame(facet.screen), box, cover);
}

void Tile::draw(const MaterialFacet& facet, const View& view) {
  Box box;
  if (!find_box(facet.screen, box)) return;
  const ScreenFrame frame(facet.screen);
  MaterialPainter painter(facet, frame, view);
  fill(facet.screen, frame, box, painter);
}

bool Tile::find_box(const Corners& corners, Box& box) {
  const ScreenVertex& a = *corners.a;
  const ScreenVertex& b = *corners.b;
  const ScreenVertex& c = *corners.c;
  const auto first = [](std::int32_t low, int origin) { return std::max((low >> 4) - origin, 0); };
  box = {first(std::min({a.x, b.x, c.x}), x_), first(std::min({a.y, b.y, c.y}), y_),
         std::min((std::max({a.x, b.x, c.x}) >> 4) - x_, width_ - 1),
         std::min((std::max({a.y, b.y, c.y}) >> 4) - y_, height_ - 1)};
  if (box.x0 > box.x1 || box.y0 > box.y1) return false;
  // Between the corners nothing is nearer than the nearest of them, but for the last digits.
  const float nearest = std::max({a.nearness, b.nearness, c.nearness}) * 1.00001f;
  if (is_hidden(nearest, box.x0, box.y0, box.x1, box.y1)) return false;
  if (++drawn_ == kLookEvery) look_how_near();
  return true;
}

template <class Painter>
void Tile::fill(const Corners& corners, const ScreenFrame& frame, const Box& box,
                Painter& painter) {
  const ScreenVertex& a = *corners.a;
  const ScreenVertex& b = *corners.b;
  const ScreenVertex& c = *corners.c;
  const auto [x0, y0, x1, y1] = box;
  const std::int32_t left = (x_ + x0) * kSubpixels;
  const std::int32_t top = (y_ + y0) * kSubpixels;
  // On the screen, with y down, corners that were counterclockwise have a negative area.
  const Side sides[] = {make_side(a, b, left, top), make_side(b, c, left, top),
                        make_side(c, a, left, top)};
  const Plane near = plane(frame, splat(a.nearness), splat(b.nearness), splat(c.nearness));
  I4 row_edge[3];
  for (int s = 0; s < 3; ++s) {
    row_edge[s] = sides[s].start + sides[s].step_x * kSampleX + sides[s].step_y * kSampleY;
  }
  const F4 sample_near =
      (to_float(kSampleX) * near.dx + to_float(kSampleY) * near.dy) * splat(1.0f / kSubpixels);
  const float ax = float(a.x) / kSubpixels;
  const float ay = float(a.y) / kSubpixels;
  // For short rows it is quicker to look at each pixel.
  const bool is_wide = x1 - x0 >= kWide;
  const Reach reach = is_wide ? Reach(sides) : Reach();
  for (int y = y0; y <= y1; ++y) {
    const Reach::Span span = is_wide ? reach.of(row_edge, x1 - x0) : Reach::Span{0, x1 - x0};
    I4 e0 = row_edge[0] + sides[0].step_x * kSubpixels * span.first;
    I4 e1 = row_edge[1] + sides[1].step_x * kSubpixels * span.first;
    I4 e2 = row_edge[2] + sides[2].step_x * kSubpixels * span.first;
    const float py = float(y_ + y) - ay;
    for (int x = x0 + span.first; x <= x0 + span.last; ++x) {
      const I4 inside = (e0 | e1 | e2) >= 0;
      if (lanes(inside) != 0) {
        const float px = float(x_ + x) - ax;
        fill_pixel(y * kTile + x, inside, near(px, py) + sample_near, painter, px, py);
      }
      e0 += sides[0].step_x * kSubpixels;
      e1 += sides[1].step_x * kSubpixels;
      e2 += sides[2].step_x * kSubpixels;
    }
    for (int s = 0; s < 3; ++s) row_edge[s] += sides[s].step_y * kSubpixels;
  }
}

template <class Painter>
inline void Tile::fill_pixel(int index, const I4& inside, const F4& nearness, Painter& painter,
                             float x, float y) {
  F4& depth = nearness_[std::size_t(index)];
  const I4 seen = inside & (painter.over() ? nearness >= depth : nearness > depth);
  const int mask = lanes(seen);
  if (mask == 0) return;
  if constexpr (!Painter::kDraws) {
    depth = as_float((seen & as_int(nearness)) | (~seen & as_int(depth)));
    return;
  } else {
    const Middle& m = kMiddles[std::size_t(mask)];
    F4 shown;
    const float alpha = painter.paint(x + m.x, y + m.y, shown);
    if (alpha <= 0) return;
    shown[3] = kOpaque;
    I4& old = colour_[std::size_t(index)];
    I4 colour = splat(pack(shown));
    if (painter.blends()) {
      if (alpha < 1) colour = mixed(old, shown, alpha);
    } else {
      depth = as_float((seen & as_int(nearness)) | (~seen & as_int(depth)));
    }
    old = (seen & colour) | (~seen & old);
  }
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
      out[3] = std::uint8_t(g >> 18 & 255);
      if (out[3] == 255) continue;
      for (int k = 0; k < 3; ++k)
        out[k] =
            std::uint8_t(out[3] == 0 ? 0 : std::min(255, (out[k] * 255 + out[3] / 2) / out[3]));
    }
  }
}

}  // namespace animeme::render::detail
