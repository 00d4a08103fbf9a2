// Base colours: factors and textures, sampled at the vertices.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/gltf/detail/pictures.h"

namespace animeme::gltf {

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

/// Reads materials.
class Paints {
 public:
  Paints(const File& file, const LoadFile& load, std::vector<std::string>& notes)
      : file_(file), notes_(notes), pictures_(file, load, notes) {}

  /// That of a primitive's material; nothing: white.
  const Paint& of(std::optional<std::size_t> material);

 private:
  Paint make(std::size_t material);
  void add_texture(const Json& info, Paint& paint);

  const File& file_;
  std::vector<std::string>& notes_;
  Pictures pictures_;
  std::map<std::size_t, Paint> paints_;
  Paint white_;
};

}  // namespace animeme::gltf
