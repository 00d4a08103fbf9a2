#include "tools/view/render/detail/material_light.h"

#include <algorithm>
#include <cmath>

namespace animeme::render::detail {
namespace {

using head::Vec3;

// What a white surface that looks at the lamp sends back.
constexpr Vec3 kKeyLamp{0.86f, 0.82f, 0.76f};
constexpr Vec3 kFillLamp{0.16f, 0.20f, 0.26f};
constexpr Vec3 kRimLamp{0.26f, 0.28f, 0.31f};
constexpr Vec3 kAbove{0.40f, 0.41f, 0.43f};
constexpr Vec3 kBelow{0.25f, 0.23f, 0.22f};
constexpr float kSmoothest = 0.045f;  // a highlight of a smoother surface falls between pixels
constexpr float kDielectric = 0.04f;  // share of light that shines at right angles

// Lambert and GGX with Smith's correlated shadowing and Schlick's Fresnel, as glTF describes them.
struct Surfaced {
  Vec3 diffuse, shine;  // colours
  Vec3 plain;           // shine of what is no metal
  float edge;           // shine at grazing angles
  float alpha;          // roughness squared
  Vec3 normal, to_eye;
  float facing;

  Vec3 lit(Vec3 to_lamp, Vec3 lamp) const {
    const float cosine = std::clamp(dot(normal, to_lamp), 0.0f, 1.0f);
    if (cosine <= 0) return {};
    const Vec3 half = normalised(to_lamp + to_eye);
    const float nh = std::clamp(dot(normal, half), 0.0f, 1.0f);
    const float vh = std::clamp(dot(to_eye, half), 0.0f, 1.0f);
    const float square = alpha * alpha;
    const float bump = nh * nh * (square - 1) + 1;
    const float spread = square / (bump * bump);  // times pi
    const float shadow =
        0.5f / std::max(cosine * std::sqrt(square + (1 - square) * facing * facing) +
                            facing * std::sqrt(square + (1 - square) * cosine * cosine),
                        1e-6f);
    const float away = 1 - vh;
    const float fresnel = away * away * away * away * away;
    const Vec3 mirror = shine * (1 - fresnel) + Vec3{edge, edge, edge} * fresnel;
    // What a surface that is no metal mirrors does not get below it.
    const Vec3 below = Vec3{1, 1, 1} - plain * (1 - fresnel) - Vec3{edge, edge, edge} * fresnel;
    return (diffuse * below + mirror * (spread * shadow)) * lamp * cosine;
  }
};

Vec3 sky_at(Vec3 direction, Vec3 up) {
  return mix(kBelow, kAbove, 0.5f + 0.5f * dot(direction, up));
}

// Khronos PBR Neutral: colours below 0.76 stay as they are.
Vec3 neutral(Vec3 c) {
  constexpr float kStart = 0.8f - 0.04f;
  constexpr float kDesaturation = 0.15f;
  const float low = std::min({c.x, c.y, c.z});
  const float offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
  c -= Vec3{offset, offset, offset};
  const float peak = std::max({c.x, c.y, c.z});
  if (!(peak >= kStart)) return c;
  constexpr float d = 1 - kStart;
  const float shown_peak = 1 - d * d / (peak + d - kStart);
  c *= shown_peak / peak;
  const float grey = 1 - 1 / (kDesaturation * (peak - shown_peak) + 1);
  return mix(c, Vec3{shown_peak, shown_peak, shown_peak}, grey);
}

Vec3 lit_material(const head::Material& material, const MaterialPoint& p, const View& view) {
  const float matt = 1 - p.metallic;
  const float rough = std::clamp(p.roughness, kSmoothest, 1.0f);
  const float plain = kDielectric * material.specular;
  const Surfaced s{p.albedo * matt,
                   mix(Vec3{plain, plain, plain}, p.albedo, p.metallic),
                   {plain, plain, plain},
                   material.specular * matt + p.metallic,
                   rough * rough,
                   p.normal,
                   p.to_eye,
                   std::clamp(dot(p.normal, p.to_eye), 0.0f, 1.0f)};
  // What lies deep gets less of the lamps, too, and the light that is left is redder.
  const Vec3 depth{std::sqrt(p.sky), p.sky, p.sky};
  Vec3 c = (s.lit(view.key, kKeyLamp) + s.lit(view.rim, kRimLamp)) * (0.25f + 0.75f * p.sky) +
           s.lit(view.fill, kFillLamp) * depth;
  // Metal shows the sky that it mirrors.
  const Vec3 mirrored = p.normal * (2 * dot(p.normal, p.to_eye)) - p.to_eye;
  c += (s.diffuse * sky_at(p.normal, {0, 1, 0}) +
        s.shine * sky_at(mirrored, {0, 1, 0}) * p.metallic) *
       depth * p.occlusion;
  return neutral(c + p.emission);
}

// MToon: between two colours by the key light; it is white and there is no other light.
Vec3 toon_material(const head::Material& material, const MaterialPoint& p, const View& view) {
  const float edge = 1 - material.toony;
  const float shading = dot(p.normal, view.key) + material.shade_shift;
  const float light = edge > 0 ? std::clamp((shading + edge) / (2 * edge), 0.0f, 1.0f)
                               : (shading >= 0 ? 1.0f : 0.0f);
  const float grazing = std::clamp(1 - dot(p.normal, p.to_eye) + material.rim_lift, 0.0f, 1.0f);
  Vec3 c = mix(p.shade, p.albedo, light) + p.emission;
  if (material.rim != Vec3{})
    c += material.rim * std::pow(grazing, std::max(material.rim_power, 1e-3f));
  return c;
}

}  // namespace

Vec3 material_light(const head::Material& material, const MaterialPoint& point, const View& view) {
  switch (material.shading) {
    case head::Shading::unlit:
      return point.albedo;
    case head::Shading::toon:
      return toon_material(material, point, view);
    case head::Shading::lit:
      break;
  }
  return lit_material(material, point, view);
}

}  // namespace animeme::render::detail
