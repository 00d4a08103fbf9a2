#include "tools/view/render/detail/material_painter.h"

#include <algorithm>
#include <cmath>

namespace animeme::render::detail {
namespace {

using head::Corner;
using head::Material;
using head::Uv;
using head::Vec3;

// Square of the length in texels of a step in the uv plane.
float texels(const head::Picture& picture, Uv from, Uv to) {
  const float x = (to.u - from.u) * float(picture.width());
  const float y = (to.v - from.v) * float(picture.height());
  return x * x + y * y;
}

// Where a pixel lies on textures, and how far its neighbours are.
struct Sampler {
  Uv at, right, below;

  head::Colour operator()(const head::Texture& texture) const {
    if (!texture) return {};
    const float most =
        std::max(texels(*texture.picture, at, right), texels(*texture.picture, at, below));
    return texture.at(at, most > 1 ? 0.5f * std::log2(most) : 0);
  }
};

}  // namespace

void MaterialPainter::make() {
  const Surface& surface = facet_.surface;
  screen_ = {facet_.screen.a, facet_.screen.b, facet_.screen.c};
  for (std::size_t k = 0; k < 3; ++k) corners_[k] = &surface.corners[facet_.corners[k]];
  if (facet_.material.normal) {
    const auto place = [&](std::size_t k) {
      return surface.transform(surface.positions[corners_[k]->vertex]);
    };
    edges_ = {place(1) - place(0), place(2) - place(0)};
  }
  ready_ = true;
}

MaterialPainter::Shares MaterialPainter::shares_at(float x, float y) const {
  const float second = (x * frame_.cy - y * frame_.cx) * frame_.scale;
  const float third = (y * frame_.bx - x * frame_.by) * frame_.scale;
  const float a = (1 - second - third) * screen_[0]->nearness;
  const float b = second * screen_[1]->nearness;
  const float c = third * screen_[2]->nearness;
  const float all = 1 / (a + b + c);
  return {a * all, b * all, c * all};
}

Uv MaterialPainter::uv_at(float x, float y) const {
  const Shares s = shares_at(x, y);
  Uv out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.u += corners_[k]->uv.u * s[k];
    out.v += corners_[k]->uv.v * s[k];
  }
  return out;
}

// Tangents are those of the facet, as shaders find them by derivatives.
Vec3 MaterialPainter::normal_at(const Shares& shares, const Vec3& texel) const {
  Vec3 n = screen_[0]->normal * shares[0] + screen_[1]->normal * shares[1] +
           screen_[2]->normal * shares[2];
  n = normalised(facet_.back ? Vec3{} - n : n);
  const Material& material = facet_.material;
  if (!material.normal) return n;
  const Uv a = corners_[0]->uv, b = corners_[1]->uv, c = corners_[2]->uv;
  const Vec3 second = cross(edges_[1], n), first = cross(n, edges_[0]);
  const Vec3 right = second * (b.u - a.u) + first * (c.u - a.u);
  const Vec3 down = second * (b.v - a.v) + first * (c.v - a.v);
  const float most = std::max(dot(right, right), dot(down, down));
  if (!(most > 0)) return n;
  const float scale = (facet_.back ? -1.0f : 1.0f) / std::sqrt(most) * material.normal_scale;
  return normalised(right * ((2 * texel.x - 1) * scale) - down * ((2 * texel.y - 1) * scale) +
                    n * (2 * texel.z - 1));
}

Vec3 MaterialPainter::place_at(float x, float y, const Shares& shares) const {
  float distance = 0;  // the shares are those of places, not of the screen
  for (std::size_t k = 0; k < 3; ++k) distance += shares[k] / screen_[k]->nearness;
  const float px = x + float(screen_[0]->x) / kSubpixels - view_.middle_x;
  const float py = y + float(screen_[0]->y) / kSubpixels - view_.middle_y;
  const Vec3 ray = view_.right * (px / view_.focus) - view_.up * (py / view_.focus) - view_.back;
  return view_.eye + ray * distance;
}

float MaterialPainter::paint(float x, float y, F4& shown_colour) {
  if (!ready_) make();
  const Material& material = facet_.material;
  const Shares shares = shares_at(x, y);
  const Sampler sampler{uv_at(x, y), uv_at(x + 1, y), uv_at(x, y + 1)};
  head::Colour base = sampler(material.base);
  Vec3 tint;
  float alpha = 0;
  float sky = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner& corner = *corners_[k];
    const Surface& surface = facet_.surface;
    const float share = shares[k];
    tint += material.vertex_colours
                ? surface.colours[corner.vertex] * share
                : Vec3{float(corner.tint[0]), float(corner.tint[1]), float(corner.tint[2])} *
                      (share / 255);
    alpha += float(corner.tint[3]) / 255 * share;
    sky += surface.occlusion[corner.vertex] * share;
  }
  base.alpha *= alpha * material.factor.alpha;
  if (material.alpha_mode == head::AlphaMode::mask && base.alpha < material.cutoff) return 0;
  if (material.alpha_mode == head::AlphaMode::blend && base.alpha <= 0) return 0;
  MaterialPoint point;
  point.albedo = base.rgb * tint * (material.vertex_colours ? Vec3{1, 1, 1} : material.factor.rgb);
  // Pictures have most of their shadows painted in; only what lies deep, as in a mouth, is dark.
  // Cards of hair lie upon each other and would get spots.
  constexpr float kDeep = 3.5f;
  const bool hair = facet_.surface.kind == head::SurfaceKind::hair;
  point.sky = hair ? 1 : std::clamp(kDeep * sky, 0.0f, 1.0f);
  if (material.shading != head::Shading::unlit) {
    point.normal = normal_at(shares, sampler(material.normal).rgb);
    point.to_eye = normalised(view_.eye - place_at(x, y, shares));
    point.emission =
        material.emission == Vec3{} ? Vec3{} : material.emission * sampler(material.emissive).rgb;
  }
  if (material.shading == head::Shading::lit) {
    const Vec3 metal = sampler(material.metal_rough).rgb;
    point.roughness = material.roughness * metal.y;
    point.metallic = material.metallic * metal.z;
    if (material.occlusion) {
      point.occlusion = 1 + material.occlusion_strength * (sampler(material.occlusion).rgb.x - 1);
    }
  }
  if (material.shading == head::Shading::toon) {
    point.shade = material.shade * tint * sampler(material.shade_texture).rgb;
  }
  const Vec3 light = material_light(material, point, view_);
  shown_colour = F4{shown(light.x), shown(light.y), shown(light.z), 0};
  return material.alpha_mode == head::AlphaMode::blend ? std::min(base.alpha, 1.0f) : 1;
}

}  // namespace animeme::render::detail
