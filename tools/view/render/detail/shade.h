// From a surface to shaded vertices on the screen.
#pragma once

#include <array>
#include <cstdint>

#include "tools/view/render/detail/grain.h"
#include "tools/view/render/raster.h"

namespace animeme::render::detail {

inline constexpr int kSubpixels = 16;  ///< steps of a pixel in which vertices are placed

/// The camera with everything that depends on it.
struct View {
  View(const Camera& camera, int width, int height);

  head::Vec3 eye, right, up, back;  // axes of the camera
  float focus;                      // pixels
  float middle_x, middle_y;         // pixels
  head::Vec3 key, fill, rim;        // towards the lights
  const GrainTable* grain = nullptr;
};

struct ScreenVertex {
  std::int32_t x = 0;  ///< 1/16 pixels
  std::int32_t y = 0;
  float nearness = 0;  ///< 1/distance; <= 0: not visible
  head::Vec3 colour;   ///< 0..255, as shown
  head::Vec3 normal;   ///< for highlights; not of length 1; of skin with grain its place there
  float grain = 0;     ///< its strength; negative: of lines
};

struct Corners {
  const ScreenVertex* a;
  const ScreenVertex* b;
  const ScreenVertex* c;
};

/// Sides of a triangle on the screen, from its first corner, in pixels.
struct ScreenFrame {
  explicit ScreenFrame(const Corners& corners);

  float bx, by, cx, cy, scale;
};

/// Vertices first .. last - 1.
void shade(const Surface& surface, const View& view, std::size_t first, std::size_t last,
           ScreenVertex* out);

/// Corners first .. last - 1 of a surface with facets: places and normals, no colours.
void place_corners(const Surface& surface, const View& view, std::size_t first, std::size_t last,
                   ScreenVertex* out);

/// sRGB value 0..255 of linear light; below 0 is 0, above 1 255.
float shown(float light);

/// How much an eye with this normal (of length 1) has of its colour below the upper lid, which is
/// between it and the light: 0.6..1.
float lid_shadow(head::Vec3 normal);

/// Added to the colour of an eye with this normal (of length 1), 0..255.
float eye_highlight(head::Vec3 normal, const View& view);

}  // namespace animeme::render::detail
