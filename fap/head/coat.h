/// @file
/// What a surface of a head of others looks like: the materials of glTF and VRM.
///
///     head::Coat coat;
///     coat.base = {std::make_shared<const head::Picture>(std::move(texels))};
///     coat.shading = head::Shading::unlit;
///
/// Heads without coats have colours at their vertices (Mesh::colours) and the looks of Material.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "fap/head/picture.h"

namespace animeme::head {

/// A picture on a surface. Without one it is white.
struct Texture {
  std::shared_ptr<const Picture> picture;  ///< shared between coats; may be null
  Wrap wrap_u = Wrap::repeat;              ///< to the left and right
  Wrap wrap_v = Wrap::repeat;              ///< above and below

  explicit operator bool() const { return picture != nullptr; }  ///< whether there is one
  /// At a place, for a pixel that is as wide as 2^`level` texels; white without a picture.
  Colour at(Uv place, float level) const {
    return picture ? picture->between(place, wrap_u, wrap_v, level) : Colour{};
  }
};

/// What opacity does.
enum class AlphaMode : std::uint8_t {
  opaque,  ///< nothing
  mask,    ///< a place is there if its opacity is `cutoff` or more
  blend,   ///< what is behind shines through
};

/// How light falls on a coat.
enum class Shading : std::uint8_t {
  lit,    ///< metallic-roughness of glTF
  unlit,  ///< shown as it is (KHR_materials_unlit)
  toon,   ///< two tones (VRMC_materials_mtoon, VRM/MToon)
};

/// A material. Colours are linear, pictures of colours sRGB; as in glTF, the value of a property is
/// its factor times its texture.
struct Coat {
  std::string name;                          ///< for people
  Shading shading = Shading::lit;            ///< how light falls on it
  AlphaMode alpha_mode = AlphaMode::opaque;  ///< what opacity does
  float cutoff = 0.5f;                       ///< of AlphaMode::mask
  bool double_sided = false;                 ///< the back is drawn, too, with its normal turned
  bool vertex_colours = false;               ///< the base is Mesh::colours: the file says nothing
  Colour factor;                             ///< of the base
  Texture base;                              ///< colour and opacity
  Texture normal;                            ///< R right, G up, B out of the surface
  float normal_scale = 1;                    ///< of its R and G
  Texture metal_rough;                       ///< G roughness, B metallic
  float metallic = 0;                        ///< 0..1
  float roughness = 1;                       ///< 0..1
  float specular = 1;                        ///< KHR_materials_specular: of the 4 % that shine
  Texture occlusion;                         ///< R: how much of the sky is seen
  float occlusion_strength = 1;              ///< 0: not looked at
  Vec3 emission;                             ///< light of its own, with its strength
  Texture emissive;                          ///< times this
  Vec3 shade;                                ///< toon: colour on the dark side
  Texture shade_texture;                     ///< toon: times this
  float shade_shift = 0;                     ///< toon: -1..1, larger is lighter
  float toony = 0.9f;                        ///< toon: 1 is a sharp border
  Vec3 rim;                                  ///< toon: light at the contour
  float rim_power = 5;                       ///< toon: how narrow it is
  float rim_lift = 0;                        ///< toon: added before the power
};

/// A vertex of what is drawn with coats: at seams of a texture several lie on one of the mesh,
/// which they move along with.
struct Corner {
  std::uint32_t vertex = 0;                                 ///< of the mesh
  Vec3 normal;                                              ///< of its maker, at rest; 0: none
  Uv uv;                                                    ///< on the textures of its coat
  std::array<std::uint8_t, 4> tint = {255, 255, 255, 255};  ///< linear RGB and opacity, times base
};

}  // namespace animeme::head
