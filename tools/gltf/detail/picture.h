// A picture that colours are taken from.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fap/head/vector.h"
#include "tools/gltf/detail/picture_decoder.h"

namespace animeme::gltf {

struct Uv {
  float u = 0;
  float v = 0;
};

/// Linear RGB and opacity.
struct Colour {
  head::Vec3 rgb = {1, 1, 1};
  float alpha = 1;
};

/// A picture in sRGB with its halves, quarters and so on.
class Picture {
 public:
  explicit Picture(DecodedPicture decoded);

  enum class Wrap : std::uint8_t { repeat, clamp, mirror };
  /// At a place in 0..1 from the upper left corner; bilinear within the level whose texels are as
  /// wide as `footprint` texels of the picture.
  Colour at(Uv place, Wrap wrap_u, Wrap wrap_v, double footprint) const;

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }

 private:
  std::vector<DecodedPicture> levels_;
};

}  // namespace animeme::gltf
