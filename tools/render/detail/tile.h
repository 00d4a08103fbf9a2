// One square of the picture: depth and colour of its samples.
#pragma once

#include <array>
#include <cstdint>

#include "tools/render/detail/shade.h"

namespace animeme::render::detail {

inline constexpr int kTile = 64;  ///< pixels a side
inline constexpr int kBlock = 8;  ///< pixels a side of the squares that are known to be covered

/// Vectors of the four samples of a pixel, by an extension that g++ and clang++ share.
using F4 = float __attribute__((vector_size(16)));
using I4 = std::int32_t __attribute__((vector_size(16)));

struct Corners {
  const ScreenVertex* a;
  const ScreenVertex* b;
  const ScreenVertex* c;
};

class Tile {
 public:
  /// Empties it: nothing near, the background's colours from the top row to the bottom.
  void start(int x, int y, const RenderOptions& options);
  /// Draws a triangle; `eye` adds highlights.
  void draw(const Corners& corners, bool eye, const View& view);
  /// Averages the samples into the picture.
  void finish(Image& image) const;

 private:
  struct Plane;
  struct Frame;
  struct Planes;
  void draw_pixel(int index, const I4& inside, const F4& nearness, Planes& planes, float x, float y,
                  const View& view);

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
  alignas(16) std::array<I4, kTile * kTile> colour_;  // 0xBBGGRR
};

}  // namespace animeme::render::detail
