#include "tools/view/gltf/detail/texture.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "fap/head/srgb.h"

namespace animeme::gltf {

namespace {

// Gives the texture that a material names.
using TextureOf = std::function<head::Texture(const Json& info, TexelKind kind)>;

using head::Material;
using head::Vec3;

Vec3 three_or(const Json& value, Vec3 otherwise) {
  const auto three = numbers(value, 3);
  if (!three) return otherwise;
  return {float((*three)[0]), float((*three)[1]), float((*three)[2])};
}

float share_or(const Json& value, double otherwise) {
  return float(std::clamp(number_or(value, otherwise), 0.0, 1.0));
}

void add_mtoon(const Json& toon, const TextureOf& texture, Material& material) {
  material.shading = head::Shading::toon;
  material.shade = three_or(member(toon, "shadeColorFactor"), {0, 0, 0});
  material.shade_texture = texture(member(toon, "shadeMultiplyTexture"), TexelKind::colour);
  material.shade_shift =
      float(std::clamp(number_or(member(toon, "shadingShiftFactor"), 0), -1.0, 1.0));
  material.toony = share_or(member(toon, "shadingToonyFactor"), 0.9);
  material.rim = three_or(member(toon, "parametricRimColorFactor"), {0, 0, 0});
  material.rim_power =
      float(std::clamp(number_or(member(toon, "parametricRimFresnelPowerFactor"), 5), 0.0, 100.0));
  material.rim_lift = share_or(member(toon, "parametricRimLiftFactor"), 0);
}

Vec3 gamma_colour(const Json& properties, const char* name, Vec3 otherwise) {
  const auto four = numbers(member(properties, "vectorProperties", name), 4);
  if (!four) return otherwise;
  return head::linear_of_srgb(Vec3{float((*four)[0]), float((*four)[1]), float((*four)[2])});
}

// VRM 0.x keeps what Unity's shader has; how its numbers become those of VRM 1.0 is told by VRM's
// own notes on migration.
void add_old_mtoon(const Json& properties, const TextureOf& texture, Material& material) {
  const auto number = [&](const char* name, double otherwise) {
    return number_or(member(properties, "floatProperties", name), otherwise);
  };
  material.shading = head::Shading::toon;
  material.factor.rgb = gamma_colour(properties, "_Color", {1, 1, 1});
  material.shade = gamma_colour(properties, "_ShadeColor", {0.97f, 0.81f, 0.86f});
  const Json& shade = member(properties, "textureProperties", "_ShadeTexture");
  if (whole(shade)) material.shade_texture = texture(Json{{"index", shade}}, TexelKind::colour);
  const double shift = std::clamp(number("_ShadeShift", 0), -1.0, 1.0);
  const double toony = std::clamp(number("_ShadeToony", 0.9), 0.0, 1.0);
  const double share = 0.5 + 0.5 * shift;
  material.toony = float(toony * (1 - share) + share);
  material.shade_shift = float(-shift) - (1 - material.toony);
  material.rim = gamma_colour(properties, "_RimColor", {0, 0, 0});
  material.rim_power = float(std::clamp(number("_RimFresnelPower", 1), 0.0, 100.0));
  material.rim_lift = float(std::clamp(number("_RimLift", 0), 0.0, 1.0));
}

void add_metal(const Json& entry, const TextureOf& texture, Material& material) {
  const Json& base = member(entry, "pbrMetallicRoughness");
  const Json& old = member(entry, "extensions", "KHR_materials_pbrSpecularGlossiness");
  if (base.is_null() && !old.is_null()) {
    material.roughness = 1 - share_or(member(old, "glossinessFactor"), 1);
    return;
  }
  // What says nothing of metal is none, whatever glTF has for it: nobody means a skin of steel.
  material.metallic = share_or(member(base, "metallicFactor"), base.is_null() ? 0 : 1);
  material.roughness = share_or(member(base, "roughnessFactor"), 1);
  material.metal_rough = texture(member(base, "metallicRoughnessTexture"), TexelKind::value);
}

// All that is drawn of a material: glTF's own, unlit, specular, emissive strength, transmission
// (as opacity), VRM 1.0's MToon and that of VRM 0.x. `paint` has its name, base and opacity.
Material read_material(const File& file, std::size_t index, const Paint& paint,
                       const TextureOf& texture) {
  const Json& entry = file.entry("materials", index);
  const Json& more = member(entry, "extensions");
  Material material;
  material.name = paint.name;
  material.alpha_mode = paint.alpha;
  material.cutoff = paint.cutoff;
  material.double_sided = is_true(member(entry, "doubleSided"));
  material.factor = paint.factor;
  material.base = {paint.picture, paint.wrap_u, paint.wrap_v};
  material.vertex_colours = !material.base && material.factor.rgb == Vec3{1, 1, 1};
  add_metal(entry, texture, material);
  material.specular = share_or(member(more, "KHR_materials_specular", "specularFactor"), 1);
  material.normal = texture(member(entry, "normalTexture"), TexelKind::value);
  material.normal_scale = float(number_or(member(entry, "normalTexture", "scale"), 1));
  material.occlusion = texture(member(entry, "occlusionTexture"), TexelKind::value);
  material.occlusion_strength = share_or(member(entry, "occlusionTexture", "strength"), 1);
  material.emission =
      three_or(member(entry, "emissiveFactor"), {0, 0, 0}) *
      float(number_or(member(more, "KHR_materials_emissive_strength", "emissiveStrength"), 1));
  if (material.emission != Vec3{}) {
    material.emissive = texture(member(entry, "emissiveTexture"), TexelKind::colour);
  }
  const double glass =
      number_or(member(more, "KHR_materials_transmission", "transmissionFactor"), 0);
  if (glass > 0 && material.alpha_mode == AlphaMode::opaque) {
    material.alpha_mode = AlphaMode::blend;
    material.factor.alpha = float(1 - 0.9 * std::clamp(glass, 0.0, 1.0));
  }
  if (!member(more, "KHR_materials_unlit").is_null()) material.shading = head::Shading::unlit;
  if (const Json& toon = member(more, "VRMC_materials_mtoon"); !toon.is_null()) {
    add_mtoon(toon, texture, material);
  }
  const auto old = list(member(file.root, "extensions", "VRM"), "materialProperties");
  if (index < old.size() && text_or(member(old[index], "shader")) == "VRM/MToon") {
    add_old_mtoon(old[index], texture, material);
  }
  return material;
}

head::Wrap wrap_of(const Json& value) {
  switch (whole_or(value, 10497)) {
    case 33071:
      return head::Wrap::clamp;
    case 33648:
      return head::Wrap::mirror;
    default:
      return head::Wrap::repeat;
  }
}

Colour factor_of(const Json& value) {
  const auto rgba = numbers(value, 4);
  if (!rgba) return {};
  const auto part = [&](std::size_t i) { return float(std::clamp((*rgba)[i], 0.0, 1.0)); };
  return {{part(0), part(1), part(2)}, part(3)};
}

std::array<std::array<float, 3>, 2> move_of(const Json& transform) {
  const auto offset = numbers(member(transform, "offset"), 2);
  const auto scale = numbers(member(transform, "scale"), 2);
  const double angle = number_or(member(transform, "rotation"), 0);
  const double c = std::cos(angle), s = std::sin(angle);
  const double x = scale ? (*scale)[0] : 1, y = scale ? (*scale)[1] : 1;
  return {{{float(c * x), float(s * y), offset ? float((*offset)[0]) : 0},
           {float(-s * x), float(c * y), offset ? float((*offset)[1]) : 0}}};
}

}  // namespace

Colour Paint::at(Uv place, double footprint) const {
  Colour colour = factor;
  if (picture) {
    const Colour texel = picture->at(moved(place), wrap_u, wrap_v, footprint);
    colour = {colour.rgb * texel.rgb, colour.alpha * texel.alpha};
  }
  if (alpha == AlphaMode::opaque) colour.alpha = 1;
  return colour;
}

Uv Paint::moved(Uv place) const {
  const Uv moved{move[0][0] * place.u + move[0][1] * place.v + move[0][2],
                 move[1][0] * place.u + move[1][1] * place.v + move[1][2]};
  // Farther away floats have no digits left for places on a picture.
  constexpr float kFar = 1e6f;
  return std::abs(moved.u) < kFar && std::abs(moved.v) < kFar ? moved : Uv{};
}

double Paint::texels(Uv a, Uv b) const {
  if (!picture) return 0;
  const double du = double(b.u) - double(a.u), dv = double(b.v) - double(a.v);
  const double x = (double(move[0][0]) * du + double(move[0][1]) * dv) * picture->width();
  const double y = (double(move[1][0]) * du + double(move[1][1]) * dv) * picture->height();
  return std::sqrt(x * x + y * y);
}

const Paint& Paints::of(std::optional<std::size_t> index) {
  if (!index) return white_;
  const auto known = paints_.find(*index);
  if (known != paints_.end()) return known->second;
  return paints_.emplace(*index, make(*index)).first->second;
}

Paint Paints::make(std::size_t index) {
  const Json& entry = file_.entry("materials", index);
  const Json& base = member(entry, "pbrMetallicRoughness");
  const Json& old = member(entry, "extensions", "KHR_materials_pbrSpecularGlossiness");
  const bool use_old = base.is_null() && !old.is_null();
  Paint paint;
  paint.name = text_or(member(entry, "name"));
  paint.factor =
      factor_of(member(use_old ? old : base, use_old ? "diffuseFactor" : "baseColorFactor"));
  const std::string mode = text_or(member(entry, "alphaMode"));
  if (mode == "MASK") paint.alpha = AlphaMode::mask;
  if (mode == "BLEND") paint.alpha = AlphaMode::blend;
  if (paint.alpha == AlphaMode::mask) {
    paint.cutoff = float(number_or(member(entry, "alphaCutoff"), 0.5));
  }
  const Json& glass = member(entry, "extensions", "KHR_materials_transmission");
  paint.see_through = number_or(member(glass, "transmissionFactor"), 0) > 0.5;
  add_base(base_texture_of(entry), paint);
  paint.textured = paint.picture != nullptr;
  constexpr std::size_t kMostMaterials = 65535;
  if (!with_materials_ || materials_.size() >= kMostMaterials) return paint;
  paint.material = materials_.size();
  materials_.push_back(read_material(file_, index, paint, [&](const Json& info, TexelKind kind) {
    return texture(info, kind, paint.name);
  }));
  const head::Material& material = materials_.back();
  paint.textured = material.base || material.normal || material.metal_rough || material.occlusion ||
                   material.emissive || material.shade_texture;
  return paint;
}

void Paints::add_base(const Json& info, Paint& paint) {
  const head::Texture base = texture(info, TexelKind::colour, paint.name);
  const Json& transform = member(info, "extensions", "KHR_texture_transform");
  paint.picture = base.picture;
  paint.wrap_u = base.wrap_u;
  paint.wrap_v = base.wrap_v;
  paint.move = move_of(transform);
  paint.uv_set = whole_or(member(transform, "texCoord"), whole_or(member(info, "texCoord"), 0));
}

head::Texture Paints::texture(const Json& info, TexelKind kind, const std::string& material) {
  const std::optional<std::size_t> index = whole(member(info, "index"));
  if (!index) return {};
  const Json& texture = file_.entry("textures", *index);
  const Json& sampler =
      file_.entry("samplers", whole_or(member(texture, "sampler"), ~std::size_t(0)));
  head::Texture out{nullptr, wrap_of(member(sampler, "wrapS")), wrap_of(member(sampler, "wrapT"))};
  if (const auto image = image_of(texture)) {
    out.picture = pictures_.of(*image, kind);
    return out;
  }
  const bool ktx2 = !member(texture, "extensions", "KHR_texture_basisu").is_null();
  notes_.push_back("a texture of material \"" + material +
                   (ktx2
                        ? "\" is KTX2 (KHR_texture_basisu) alone and is left out, so it has its "
                          "plain colour: export it as PNG, JPEG or WebP"
                        : "\" is neither PNG nor JPEG nor WebP and is left out: export it as PNG"));
  return out;
}

}  // namespace animeme::gltf
