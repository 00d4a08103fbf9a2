/// @file
/// Materials of heads from files: those of glTF and VRM.
///
///     head::Material material;
///     material.base = {std::make_shared<const head::Picture>(std::move(texels))};
///     material.shading = head::Shading::unlit;
///
/// Heads without materials have vertex colours (Mesh::colours) and the built-in looks of
/// SurfaceKind.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "fap/head/picture.h"

namespace animeme::head {

/// An image on a surface. White without an image.
struct Texture {
  std::shared_ptr<const Picture> picture;  ///< shared between materials; may be null
  Wrap wrap_u = Wrap::repeat;              ///< to the left and right
  Wrap wrap_v = Wrap::repeat;              ///< above and below

  explicit operator bool() const { return picture != nullptr; }  ///< whether there is an image
  /// Colour at a position, for a pixel that is as wide as 2^`level` texels; white without an image.
  Colour at(Uv place, float level) const {
    return picture ? picture->between(place, wrap_u, wrap_v, level) : Colour{};
  }
};

/// Use of the opacity.
enum class AlphaMode : std::uint8_t {
  opaque,  ///< ignored
  mask,    ///< visible where the opacity is at least `cutoff`
  blend,   ///< transparent
};

/// Shading model of a material.
enum class Shading : std::uint8_t {
  lit,    ///< metallic-roughness of glTF
  unlit,  ///< constant colour (KHR_materials_unlit)
  toon,   ///< two tones (VRMC_materials_mtoon, VRM/MToon)
};

/// A material. Colours are linear, colour textures sRGB; as in glTF, the value of a property is its
/// factor times its texture.
struct Material {
  std::string name;                          ///< for people
  Shading shading = Shading::lit;            ///< see Shading
  AlphaMode alpha_mode = AlphaMode::opaque;  ///< see AlphaMode
  float cutoff = 0.5f;                       ///< of AlphaMode::mask
  bool double_sided = false;                 ///< back faces are drawn, with inverted normals
  bool vertex_colours = false;               ///< the base is Mesh::colours: the file has none
  Colour factor;                             ///< of the base
  Texture base;                              ///< colour and opacity
  Texture normal;                            ///< R right, G up, B out of the surface
  float normal_scale = 1;                    ///< of its R and G
  Texture metal_rough;                       ///< G roughness, B metallic
  float metallic = 0;                        ///< 0..1
  float roughness = 1;                       ///< 0..1
  float specular = 1;                        ///< KHR_materials_specular: factor of the 4 % at F0
  Texture occlusion;                         ///< R: ambient occlusion, 1 is unoccluded
  float occlusion_strength = 1;              ///< 0: ignored
  Vec3 emission;                             ///< emitted light, with its strength
  Texture emissive;                          ///< times this
  Vec3 shade;                                ///< toon: colour on the dark side
  Texture shade_texture;                     ///< toon: times this
  float shade_shift = 0;                     ///< toon: -1..1, larger is lighter
  float toony = 0.9f;                        ///< toon: 1 is a sharp border
  Vec3 rim;                                  ///< toon: light at the silhouette
  float rim_power = 5;                       ///< toon: how narrow it is
  float rim_lift = 0;                        ///< toon: added before the power
};

/// A vertex as drawn with materials: at texture seams several corners share one vertex of the mesh
/// and move with it.
struct Corner {
  std::uint32_t vertex = 0;                                 ///< of the mesh
  Vec3 normal;                                              ///< from the file, at rest; 0: none
  Uv uv;                                                    ///< on the textures of its material
  std::array<std::uint8_t, 4> tint = {255, 255, 255, 255};  ///< linear RGB, opacity; times base
};

}  // namespace animeme::head
