#include "tools/view/gltf/detail/material.h"

#include <algorithm>

#include "fap/head/srgb.h"

namespace animeme::gltf {
namespace {

using head::Coat;
using head::Vec3;

Vec3 three_or(const Json& value, Vec3 otherwise) {
  const auto three = numbers(value, 3);
  if (!three) return otherwise;
  return {float((*three)[0]), float((*three)[1]), float((*three)[2])};
}

float share_or(const Json& value, double otherwise) {
  return float(std::clamp(number_or(value, otherwise), 0.0, 1.0));
}

void add_mtoon(const Json& toon, const TextureOf& texture, Coat& coat) {
  coat.shading = head::Shading::toon;
  coat.shade = three_or(member(toon, "shadeColorFactor"), {0, 0, 0});
  coat.shade_texture = texture(member(toon, "shadeMultiplyTexture"), TexelKind::colour);
  coat.shade_shift = float(std::clamp(number_or(member(toon, "shadingShiftFactor"), 0), -1.0, 1.0));
  coat.toony = share_or(member(toon, "shadingToonyFactor"), 0.9);
  coat.rim = three_or(member(toon, "parametricRimColorFactor"), {0, 0, 0});
  coat.rim_power =
      float(std::clamp(number_or(member(toon, "parametricRimFresnelPowerFactor"), 5), 0.0, 100.0));
  coat.rim_lift = share_or(member(toon, "parametricRimLiftFactor"), 0);
}

Vec3 gamma_colour(const Json& properties, const char* name, Vec3 otherwise) {
  const auto four = numbers(member(properties, "vectorProperties", name), 4);
  if (!four) return otherwise;
  return head::linear_of_srgb(Vec3{float((*four)[0]), float((*four)[1]), float((*four)[2])});
}

// VRM 0.x keeps what Unity's shader has; how its numbers become those of VRM 1.0 is told by VRM's
// own notes on migration.
void add_old_mtoon(const Json& properties, const TextureOf& texture, Coat& coat) {
  const auto number = [&](const char* name, double otherwise) {
    return number_or(member(properties, "floatProperties", name), otherwise);
  };
  coat.shading = head::Shading::toon;
  coat.factor.rgb = gamma_colour(properties, "_Color", {1, 1, 1});
  coat.shade = gamma_colour(properties, "_ShadeColor", {0.97f, 0.81f, 0.86f});
  const Json& shade = member(properties, "textureProperties", "_ShadeTexture");
  if (whole(shade)) coat.shade_texture = texture(Json{{"index", shade}}, TexelKind::colour);
  const double shift = std::clamp(number("_ShadeShift", 0), -1.0, 1.0);
  const double toony = std::clamp(number("_ShadeToony", 0.9), 0.0, 1.0);
  const double share = 0.5 + 0.5 * shift;
  coat.toony = float(toony * (1 - share) + share);
  coat.shade_shift = float(-shift) - (1 - coat.toony);
  coat.rim = gamma_colour(properties, "_RimColor", {0, 0, 0});
  coat.rim_power = float(std::clamp(number("_RimFresnelPower", 1), 0.0, 100.0));
  coat.rim_lift = float(std::clamp(number("_RimLift", 0), 0.0, 1.0));
}

void add_metal(const Json& entry, const TextureOf& texture, Coat& coat) {
  const Json& base = member(entry, "pbrMetallicRoughness");
  const Json& old = member(entry, "extensions", "KHR_materials_pbrSpecularGlossiness");
  if (base.is_null() && !old.is_null()) {
    coat.roughness = 1 - share_or(member(old, "glossinessFactor"), 1);
    return;
  }
  // What says nothing of metal is none, whatever glTF has for it: nobody means a skin of steel.
  coat.metallic = share_or(member(base, "metallicFactor"), base.is_null() ? 0 : 1);
  coat.roughness = share_or(member(base, "roughnessFactor"), 1);
  coat.metal_rough = texture(member(base, "metallicRoughnessTexture"), TexelKind::value);
}

}  // namespace

Coat read_coat(const File& file, std::size_t material, const Paint& paint,
               const TextureOf& texture) {
  const Json& entry = file.entry("materials", material);
  const Json& more = member(entry, "extensions");
  Coat coat;
  coat.name = paint.name;
  coat.alpha_mode = paint.alpha;
  coat.cutoff = paint.cutoff;
  coat.double_sided = is_true(member(entry, "doubleSided"));
  coat.factor = paint.factor;
  coat.base = {paint.picture, paint.wrap_u, paint.wrap_v};
  coat.vertex_colours = !coat.base && coat.factor.rgb == Vec3{1, 1, 1};
  add_metal(entry, texture, coat);
  coat.specular = share_or(member(more, "KHR_materials_specular", "specularFactor"), 1);
  coat.normal = texture(member(entry, "normalTexture"), TexelKind::value);
  coat.normal_scale = float(number_or(member(entry, "normalTexture", "scale"), 1));
  coat.occlusion = texture(member(entry, "occlusionTexture"), TexelKind::value);
  coat.occlusion_strength = share_or(member(entry, "occlusionTexture", "strength"), 1);
  coat.emission =
      three_or(member(entry, "emissiveFactor"), {0, 0, 0}) *
      float(number_or(member(more, "KHR_materials_emissive_strength", "emissiveStrength"), 1));
  if (coat.emission != Vec3{}) {
    coat.emissive = texture(member(entry, "emissiveTexture"), TexelKind::colour);
  }
  const double glass =
      number_or(member(more, "KHR_materials_transmission", "transmissionFactor"), 0);
  if (glass > 0 && coat.alpha_mode == AlphaMode::opaque) {
    coat.alpha_mode = AlphaMode::blend;
    coat.factor.alpha = float(1 - 0.9 * std::clamp(glass, 0.0, 1.0));
  }
  if (!member(more, "KHR_materials_unlit").is_null()) coat.shading = head::Shading::unlit;
  if (const Json& toon = member(more, "VRMC_materials_mtoon"); !toon.is_null()) {
    add_mtoon(toon, texture, coat);
  }
  const auto old = list(member(file.root, "extensions", "VRM"), "materialProperties");
  if (material < old.size() && text_or(member(old[material], "shader")) == "VRM/MToon") {
    add_old_mtoon(old[material], texture, coat);
  }
  return coat;
}

}  // namespace animeme::gltf
