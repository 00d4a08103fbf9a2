#include "tools/view/render/detail/shade.h"

#include <algorithm>
#include <cmath>

#include "fap/head/srgb.h"

namespace animeme::render::detail {
namespace {

using head::dot;
using head::normalised;
using head::SurfaceKind;
using head::Vec3;

constexpr int kShownSteps = 4096;

const std::array<float, kShownSteps + 2>& shown_table() {
  static const std::array<float, kShownSteps + 2> table = [] {
    std::array<float, kShownSteps + 2> t{};
    for (int i = 0; i < kShownSteps + 2; ++i) {
      const double v = std::min(double(i) / kShownSteps, 1.0);
      t[std::size_t(i)] = float(255 * head::srgb_of_linear(v));
    }
    return t;
  }();
  return table;
}

// How a material answers to light.
struct Look {
  Vec3 wrap;      // how far light goes around, red first
  float shine;    // strength of the highlight
  int sharpness;  // its exponent is 2^sharpness
  float rim;
  float tint = 0;  // of the highlight: 0 white, 1 as the surface
};

constexpr Look kLooks[] = {  // in the order of head::SurfaceKind
    {{0.42f, 0.22f, 0.16f}, 0.10f, 4, 0.22f},
    {{0.25f, 0.22f, 0.20f}, 0, 1, 0},
    {{0.2f, 0.2f, 0.2f}, 0.35f, 5, 0},
    {{0.3f, 0.15f, 0.1f}, 0.25f, 5, 0},
    {{0.15f, 0.12f, 0.10f}, 0.14f, 4, 0.3f, 0.85f},
    {{0.15f, 0.15f, 0.15f}, 0.02f, 3, 0.12f}};

float power(float base, int squarings) {
  for (int i = 0; i < squarings; ++i) base *= base;
  return base;
}

float wrapped(float cosine, float wrap) {
  const float v = std::max((cosine + wrap) * (1 / (1 + wrap)), 0.0f);
  return v * (0.35f + 0.65f * v);
}

constexpr Vec3 kKey{2.35f, 2.20f, 2.0f};
constexpr Vec3 kFill{0.34f, 0.42f, 0.54f};
constexpr Vec3 kSky{0.46f, 0.48f, 0.52f};
constexpr Vec3 kGround{0.26f, 0.22f, 0.20f};
constexpr Vec3 kRim{0.85f, 0.92f, 1.0f};
constexpr float kExposure = 0.62f;

Vec3 lit(Vec3 n, Vec3 to_eye, Vec3 albedo, float sky, const Look& look, float gloss,
         const View& view) {
  const float key = dot(n, view.key);
  const float fill = wrapped(dot(n, view.fill), 0.3f);
  const float up = 0.5f + 0.5f * n.y;
  // What lies deep gets less of the key, too, and the light that is left is redder.
  const float key_sky = 0.25f + 0.75f * sky;
  const Vec3 tint{std::sqrt(sky), sky, sky};
  Vec3 light =
      kKey * Vec3{wrapped(key, look.wrap.x), wrapped(key, look.wrap.y), wrapped(key, look.wrap.z)} *
      key_sky;
  light += (kFill * fill + mix(kGround, kSky, up)) * tint;
  Vec3 c = albedo * light;
  const float facing = std::max(dot(n, to_eye), 0.0f);
  const float edge = 1 - facing;
  c += kRim * (look.rim * edge * edge * edge * std::max(dot(n, view.rim) + 0.25f, 0.0f) * sky);
  const float half = std::max(dot(n, normalised(view.key + to_eye)), 0.0f);
  const Vec3 tone = mix(Vec3{1, 1, 1}, albedo * 6.0f, look.tint);
  c += kKey * tone *
       (look.shine * gloss * power(half, look.sharpness) * key_sky * std::max(key, 0.0f));
  return c * kExposure;
}

// The window of an eye is rounder than the ball, so it shows the lamp from most sides.
Vec3 cornea(Vec3 normal, Vec3 gaze) {
  const float ahead = dot(normal, gaze);
  return normal + (normal - gaze * ahead) * (0.5f * head::smooth_step(0.2f, 1.0f, ahead));
}

// The shown value after the filmic curve.
float filmic(float x) { return shown(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f)); }

// The maker's normal turns as that of the mesh does.
Vec3 turned_along(Vec3 normal, Vec3 from, Vec3 to) {
  const float cosine = dot(from, to);
  if (cosine < -0.9f) return to;
  const Vec3 axis = cross(from, to);
  const Vec3 across = cross(axis, normal);
  return normal + across + cross(axis, across) * (1 / (1 + cosine));
}

// Puts a place on the screen; the way to it from the eye.
Vec3 put(Vec3 place, const View& view, ScreenVertex& v) {
  const Vec3 from_eye = place - view.eye;
  const float distance = -dot(from_eye, view.back);
  v.nearness = distance > 1 ? 1 / distance : 0;
  const float px = view.middle_x + view.focus * dot(from_eye, view.right) * v.nearness;
  const float py = view.middle_y - view.focus * dot(from_eye, view.up) * v.nearness;
  constexpr float kFar = 1 << 14;  // far outside of any picture; the product of two fits 64 bits
  v.x = std::int32_t(std::lrint(std::clamp(px, -kFar, kFar) * kSubpixels));
  v.y = std::int32_t(std::lrint(std::clamp(py, -kFar, kFar) * kSubpixels));
  return from_eye;
}

}  // namespace

float shown(float light) {
  const float x = (light > 0 ? std::min(light, 1.0f) : 0) * kShownSteps;
  const int i = int(x);
  const auto& table = shown_table();
  return table[std::size_t(i)] +
         (table[std::size_t(i + 1)] - table[std::size_t(i)]) * (x - float(i));
}

View::View(const Camera& camera, int width, int height) : eye(camera.eye) {
  back = normalised(camera.eye - camera.target);
  right = normalised(cross(camera.up, back));
  up = cross(back, right);
  focus = 0.5f * float(height) / std::tan(camera.view_angle / 2);
  middle_x = 0.5f * float(width);
  middle_y = 0.5f * float(height);
  key = normalised(right * 0.55f + up * 0.62f + back * 0.75f);
  fill = normalised(right * -0.9f + up * 0.1f + back * 0.5f);
  rim = normalised(right * -0.7f + up * 0.5f + back * -0.8f);
}

void shade(const Surface& surface, const View& view, std::size_t first, std::size_t last,
           ScreenVertex* out) {
  const Look& look = kLooks[std::size_t(surface.kind)];
  const Vec3 gaze = surface.transform.turn({0, 0, 1});
  const std::size_t count = surface.positions.size();
  const bool grained = surface.grain.size() == count && surface.positions_at_rest.size() == count;
  for (std::size_t i = first; i < last; ++i) {
    const Vec3 place = surface.transform(surface.positions[i]);
    const Vec3 normal = surface.transform.turn(surface.normals[i]);
    const Vec3 from_eye = put(place, view, out[i]);
    ScreenVertex& v = out[i];
    v.normal = surface.kind == SurfaceKind::eye ? cornea(normal, gaze) : normal;
    v.grain = 0;
    const Vec3 to_eye = normalised(Vec3{} - from_eye);
    if (dot(to_eye, normal) < -0.5f) continue;  // no triangle that is seen has such a corner
    const head::Grain grain = grained ? surface.grain[i] : head::Grain{};
    const Vec3 c =
        lit(normal, to_eye, surface.colours[i], surface.occlusion[i], look, grain.gloss, view);
    if (grained && view.grain->seen()) {
      v.grain = kGrainStrength * grain.relief;
      v.normal = view.grain->place(surface.positions_at_rest[i]);
    }
    v.colour = {filmic(c.x), filmic(c.y), filmic(c.z)};
  }
}

ScreenFrame::ScreenFrame(const Corners& corners)
    : bx(float(corners.b->x - corners.a->x) / kSubpixels),
      by(float(corners.b->y - corners.a->y) / kSubpixels),
      cx(float(corners.c->x - corners.a->x) / kSubpixels),
      cy(float(corners.c->y - corners.a->y) / kSubpixels),
      scale(1 / (bx * cy - by * cx)) {}

void place_corners(const Surface& surface, const View& view, std::size_t first, std::size_t last,
                   ScreenVertex* out) {
  for (std::size_t i = first; i < last; ++i) {
    const head::Corner& corner = surface.corners[i];
    const std::uint32_t vertex = corner.vertex;
    out[i].nearness = 0;
    if (vertex >= surface.positions.size()) continue;
    put(surface.transform(surface.positions[vertex]), view, out[i]);
    Vec3 normal = surface.normals[vertex];
    if (corner.normal != Vec3{} && vertex < surface.normals_at_rest.size()) {
      normal = turned_along(corner.normal, surface.normals_at_rest[vertex], normal);
    }
    out[i].normal = surface.transform.turn(normal);
  }
}

float lid_shadow(Vec3 normal) { return 1 - 0.4f * head::smooth_step(0.0f, 0.42f, normal.y); }

float eye_highlight(Vec3 normal, const View& view) {
  const float key = std::max(dot(normal, normalised(view.key + view.back)), 0.0f);
  return 235 * head::smooth_step(0.972f, 0.983f, key) + 30 * power(key, 5);
}

}  // namespace animeme::render::detail
