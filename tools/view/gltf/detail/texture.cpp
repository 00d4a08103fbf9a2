#include "tools/view/gltf/detail/texture.h"

#include <algorithm>
#include <cmath>

#include "tools/view/gltf/detail/material.h"

namespace animeme::gltf {
namespace {

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

const Paint& Paints::of(std::optional<std::size_t> material) {
  if (!material) return white_;
  const auto known = paints_.find(*material);
  if (known != paints_.end()) return known->second;
  return paints_.emplace(*material, make(*material)).first->second;
}

Paint Paints::make(std::size_t material) {
  const Json& entry = file_.entry("materials", material);
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
  constexpr std::size_t kMostCoats = 65535;
  if (!with_coats_ || coats_.size() >= kMostCoats) return paint;
  paint.coat = coats_.size();
  coats_.push_back(read_coat(file_, material, paint, [&](const Json& info, TexelKind kind) {
    return texture(info, kind, paint.name);
  }));
  const head::Coat& coat = coats_.back();
  paint.textured = coat.base || coat.normal || coat.metal_rough || coat.occlusion ||
                   coat.emissive || coat.shade_texture;
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
