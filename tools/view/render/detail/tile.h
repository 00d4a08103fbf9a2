// One square of the picture: depth and colour of its samples.
#pragma once

#include <array>
#include <cstdint>

#include "tools/view/render/detail/material_painter.h"
#include "tools/view/render/detail/side.h"

namespace animeme::render::detail {

inline constexpr int kTile = 64;  ///< pixels a side
inline constexpr int kBlock = 8;  ///< pixels a side of the squares that are known to be covered

class Tile {
 public:
  /// Empties it: nothing near, the background's colours from the top row to the bottom.
  void start(int x, int y, const RenderOptions& options);
  /// Draws a triangle; `eye` adds highlights.
  void draw(const Corners& corners, bool eye, const View& view);
  /// Notes how near a facet is, without drawing it, so that draw() has to look at what is seen
  /// only.
  void cover(const MaterialFacet& facet);
  /// Draws a facet by its material. One that blends goes over what is there and hides nothing: draw
  /// them last, and those that are far away first.
  void draw(const MaterialFacet& facet, const View& view);
  /// Averages the samples into the picture.
  void finish(Image& image) const;

 private:
  struct Plane;
  struct Planes;
  struct Cover;
  static Plane plane(const ScreenFrame& frame, F4 a, F4 b, F4 c);
  // Pixels that a triangle may cover, both ends included.
  struct Box {
    int x0, y0, x1, y1;
  };
  bool find_box(const Corners& corners, Box& box);  // false: nothing of it is seen
  template <class Painter>
  void fill(const Corners& corners, const ScreenFrame& frame, const Box& box, Painter& painter);
  template <class Painter>
  void fill_pixel(int index, const I4& inside, const F4& nearness, Painter& painter, float x,
                  float y);

  void show_behind(const Image& picture);
  void look_how_near();
  bool is_hidden(float nearest, int x0, int y0, int x1, int y1) const;

  static constexpr int kBlocks = kTile / kBlock;
  /// For each square of the tile: nothing in it is farther away than this. Looked up now and then,
  /// so it may be too careful.
  std::array<float, kBlocks * kBlocks> farthest_;
  int drawn_ = 0;  // triangles since then
  int x_ = 0;
  int y_ = 0;
  int width_ = 0;
  int height_ = 0;
  alignas(16) std::array<F4, kTile * kTile> nearness_;
  alignas(16) std::array<I4, kTile * kTile> colour_;  // 0xAABBGGRR, multiplied with alpha
};

}  // namespace animeme::render::detail
