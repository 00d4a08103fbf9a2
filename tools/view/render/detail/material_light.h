// Light on materials: glTF's metallic-roughness, two tones, none.
#pragma once

#include "fap/head/material.h"
#include "tools/view/render/detail/shade.h"

namespace animeme::render::detail {

/// What textures and factors say of a point. Unlit materials have albedo alone.
struct MaterialPoint {
  head::Vec3 albedo;
  head::Vec3 normal;  ///< length 1, towards the camera's side
  head::Vec3 to_eye;  ///< length 1
  head::Vec3 emission;
  head::Vec3 shade;  ///< toon
  float metallic = 0;
  float roughness = 1;
  float occlusion = 1;  ///< by the material: of the sky alone
  float sky = 1;        ///< by the head: how much of it is seen
};

/// Linear light as it is to be shown, 0..1. A white, rough surface before the camera shows about
/// its own colour; brighter light goes through Khronos' neutral tone mapper. js/material_shaders.js
/// repeats all of it.
head::Vec3 material_light(const head::Material& material, const MaterialPoint& point,
                          const View& view);

}  // namespace animeme::render::detail
