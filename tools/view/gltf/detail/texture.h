// Base colours: factors and textures, sampled at the vertices.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fap/head/material.h"
#include "tools/view/gltf/detail/pictures.h"

namespace animeme::gltf {

using head::AlphaMode;

/// What a material says of colours.
struct Paint {
  std::string name;
  Colour factor;  ///< base colour
  std::shared_ptr<const Picture> picture;
  std::size_t uv_set = 0;
  head::Wrap wrap_u = head::Wrap::repeat;
  head::Wrap wrap_v = head::Wrap::repeat;
  /// KHR_texture_transform: a row for u, a row for v.
  std::array<std::array<float, 3>, 2> move = {{{1, 0, 0}, {0, 1, 0}}};
  AlphaMode alpha = AlphaMode::opaque;
  float cutoff = 0.5f;
  bool see_through = false;  ///< glass: transmission above one half
  std::size_t material = 0;  ///< index of Paints::materials()
  bool textured = false;     ///< its material has a picture

  /// Factor times texture; alpha is 1 if the material is opaque.
  Colour at(Uv place, double footprint) const;
  /// A length in the uv plane in texels of the picture, 0 without one.
  double texels(Uv a, Uv b) const;
  /// Where a place is on the pictures: `move` applied.
  Uv moved(Uv place) const;
};

/// Reads materials.
class Paints {
 public:
  /// Without `materials` base colours alone are read.
  Paints(const File& file, const LoadFile& load, std::vector<std::string>& notes, bool materials)
      : file_(file), notes_(notes), with_materials_(materials), pictures_(file, load, notes) {
    materials_.emplace_back().vertex_colours = true;
  }

  /// That of a primitive's material; nothing: white.
  const Paint& of(std::optional<std::size_t> index);
  /// Of all materials that were asked for.
  std::vector<head::Material> take_materials() { return std::move(materials_); }

 private:
  Paint make(std::size_t index);
  void add_base(const Json& info, Paint& paint);
  head::Texture texture(const Json& info, TexelKind kind, const std::string& material);

  const File& file_;
  std::vector<std::string>& notes_;
  bool with_materials_;
  Pictures pictures_;
  std::map<std::size_t, Paint> paints_;
  std::vector<head::Material> materials_;  // the first one is that of `white_`
  Paint white_;
};

}  // namespace animeme::gltf
