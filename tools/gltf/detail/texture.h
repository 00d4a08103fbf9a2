// Base colours: factors and textures, sampled at the vertices.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "fap/head/vector.h"
#include "tools/gltf/detail/file.h"

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
  /// PNG or JPEG of at most 16384 x 16384 texels, 64 million in all. Nothing if it is not.
  static std::shared_ptr<const Picture> decode(std::span<const std::uint8_t> bytes);

  enum class Wrap : std::uint8_t { repeat, clamp, mirror };
  /// At a place in 0..1 from the upper left corner; bilinear within the level whose texels are as
  /// wide as `footprint` texels of the picture.
  Colour at(Uv place, Wrap wrap_u, Wrap wrap_v, double footprint) const;

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;
  };
  std::vector<Level> levels_;
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// What a material says of colours.
struct Paint {
  std::string name;
  Colour factor;  ///< base colour
  std::shared_ptr<const Picture> picture;
  std::size_t uv_set = 0;
  Picture::Wrap wrap_u = Picture::Wrap::repeat;
  Picture::Wrap wrap_v = Picture::Wrap::repeat;
  /// KHR_texture_transform: a row for u, a row for v.
  std::array<std::array<float, 3>, 2> move = {{{1, 0, 0}, {0, 1, 0}}};
  AlphaMode alpha = AlphaMode::opaque;
  float cutoff = 0.5f;
  bool see_through = false;  ///< glass: transmission above one half

  /// Factor times texture; alpha is 1 if the material is opaque.
  Colour at(Uv place, double footprint) const;
  /// A length in the uv plane in texels of the picture, 0 without one.
  double texels(Uv a, Uv b) const;
};

/// Reads materials, each picture once.
class Paints {
 public:
  Paints(const File& file, const LoadFile& load, std::vector<std::string>& notes)
      : file_(file), load_(load), notes_(notes) {}

  /// That of a primitive's material; nothing: white.
  const Paint& of(std::optional<std::size_t> material);

 private:
  Paint make(std::size_t material);
  void add_texture(const Json& info, Paint& paint);
  std::shared_ptr<const Picture> picture(std::size_t image);

  const File& file_;
  const LoadFile& load_;
  std::vector<std::string>& notes_;
  std::vector<std::pair<std::size_t, std::unique_ptr<Paint>>> paints_;
  std::vector<std::pair<std::size_t, std::shared_ptr<const Picture>>> pictures_;
  Paint white_;
};

}  // namespace animeme::gltf
