#include "fap/head/detail/own_steps.h"

#include <algorithm>

#include "fap/head/detail/paint.h"

namespace animeme::head::detail {
namespace {

struct MaterialLook {
  SurfaceKind surface;
  std::uint32_t colour;
};

MaterialLook look_of(Part part) {
  const HeadParameters usual;
  switch (part) {
    case Part::skin:
      return {SurfaceKind::skin, usual.skin_colour};
    case Part::left_eye:
    case Part::right_eye:
      return {SurfaceKind::eye, 0xF2EEE8};
    case Part::upper_teeth:
    case Part::lower_teeth:
      return {SurfaceKind::teeth, 0xEFE9DC};
    case Part::tongue:
      return {SurfaceKind::wet, 0xB8585A};
    case Part::hair:
      return {SurfaceKind::hair, usual.hair_colour};
    case Part::brows:
    case Part::lashes:
      return {SurfaceKind::hair, usual.brow_colour};
    case Part::body:
      return {SurfaceKind::cloth, usual.cloth_colour};
  }
  return {SurfaceKind::skin, usual.skin_colour};
}

// Where q.y lies between the heights of the points of a contour at q.x; both ends count as outside.
struct Contour {
  std::vector<Vec3> upper, lower;  // from the right corner to the left one

  static float height(const std::vector<Vec3>& line, float x) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      if (x >= line[i].x && x <= line[i + 1].x) {
        const float width = std::max(line[i + 1].x - line[i].x, 1e-6f);
        return line[i].y + (line[i + 1].y - line[i].y) * (x - line[i].x) / width;
      }
    }
    return 0;
  }
};

std::vector<Vec3> line_of(const Head& head, std::initializer_list<const char*> ids) {
  std::vector<Vec3> line;
  for (const char* id : ids) {
    if (head.point(id).exists()) line.push_back(head.at(id));
  }
  std::sort(line.begin(), line.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
  return line;
}

void paint_lips(const std::vector<bool>& unknown, Head& head) {
  const Contour outer{line_of(head, {"8.4", "8.6", "8.9", "8.1", "8.10", "8.5", "8.3"}),
                      line_of(head, {"8.4", "8.8", "8.2", "8.7", "8.3"})};
  if (!head.point("8.3").exists() || !head.point("8.4").exists() || outer.upper.size() < 3 ||
      outer.lower.size() < 3) {
    return;
  }
  const float right = head.at("8.4").x;
  const float left = head.at("8.3").x;
  const float edge = 0.05f * float(head.fapu.mns);
  const float deep = std::min(head.at("8.3").z, head.at("8.4").z) - float(head.fapu.mns);
  const Vec3 lip = linear_colour(HeadParameters{}.lip_colour);
  Mesh& skin = head.part(Part::skin);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3 p = skin.positions[v];
    if (!unknown[v] || p.x <= right || p.x >= left || p.z < deep) continue;
    const float inside =
        std::min(Contour::height(outer.upper, p.x) - p.y, p.y - Contour::height(outer.lower, p.x));
    skin.colours[v] = mix(skin.colours[v], lip, smooth_step(-edge, edge, inside));
  }
}

// What is behind the front of the lips and before the throat, as high as the mouth, and sees no
// sky.
void paint_mouth(const std::vector<bool>& unknown, Head& head) {
  for (const char* id : {"2.2", "2.4", "2.5"}) {
    if (head.point(id).part != Part::skin || !head.point(id).exists()) return;
  }
  constexpr float kBeyond = 1.8f;  // cheeks hide more than the lips open
  const Vec3 front = head.at("2.2");
  const Vec3 left = head.at("2.4"), right = head.at("2.5");
  const float half = 0.5f * (left.x - right.x), middle = 0.5f * (left.x + right.x);
  const float mns = float(head.fapu.mns);
  if (!(half > 0)) return;
  Mesh& skin = head.part(Part::skin);
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3 p = skin.positions[v];
    const float aside = std::abs(p.x - middle) / half;
    const float up = (p.y - front.y) / mns;
    if (!unknown[v] || aside > kBeyond || up < -1.3f || up > 1.2f) continue;
    const float corner = p.x > middle ? left.z : right.z;
    const float depth = (front.z + (corner - front.z) * aside * aside - p.z) / mns;
    if (depth < 0.1f || depth > 3.2f) continue;
    skin.colours[v] =
        mix(skin.colours[v], kMouthInside, smooth_step(0.25f, 0.1f, skin.occlusion[v]));
  }
}

void paint_eye(const Eye& eye, const std::vector<bool>& unknown, Mesh& mesh) {
  const Vec3 iris = linear_colour(HeadParameters{}.iris_colour);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 q = mesh.positions[v] - eye.centre;
    if (!unknown[v] || q.z <= 0) continue;
    const float r = std::hypot(q.x, q.y);
    const float within = 1 - smooth_step(0.95f, 1.05f, r / eye.iris_radius);
    const float dark = 1 - smooth_step(0.9f, 1.1f, r / eye.pupil_radius);
    mesh.colours[v] = mix(mesh.colours[v], mix(iris, Vec3{0.004f, 0.004f, 0.004f}, dark), within);
  }
}

}  // namespace

void colour_parts(Head& head) {
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    Mesh& mesh = head.parts[i];
    const MaterialLook look = look_of(Part(i));
    mesh.surface = look.surface;
    std::vector<bool> unknown(mesh.positions.size());
    for (std::size_t v = 0; v < unknown.size(); ++v) {
      unknown[v] = mesh.colours[v] == kNoColour;
      if (unknown[v]) mesh.colours[v] = linear_colour(look.colour);
    }
    if (Part(i) == Part::skin) {
      paint_lips(unknown, head);
      paint_mouth(unknown, head);
    }
    if (Part(i) == Part::left_eye) paint_eye(head.eyes[0], unknown, mesh);
    if (Part(i) == Part::right_eye) paint_eye(head.eyes[1], unknown, mesh);
  }
}

}  // namespace animeme::head::detail
