#include "tools/view/render/scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace animeme::render {
namespace {

double crown_of(const head::Head& head) {
  if (head.point("11.4").exists()) return head.at("11.4").y;
  // Not higher than a head is, if the mesh is a whole figure with a hat.
  const float most = 2.2f * float(head.fapu.es);
  float top = 0;
  for (const head::Part part : {head::Part::skin, head::Part::hair}) {
    for (const head::Vec3& p : head.part(part).positions) top = std::max(top, p.y);
  }
  return double(std::min(top, most));
}

}  // namespace

Scene scene_of(const head::Head& head, const head::Rig& rig, const head::Pose& pose) {
  Scene scene;
  // First what covers much, so that the rest is seen to be hidden at once.
  using head::Part;
  for (const Part part :
       {Part::skin, Part::hair, Part::body, Part::left_eye, Part::right_eye, Part::upper_teeth,
        Part::lower_teeth, Part::tongue, Part::brows, Part::lashes}) {
    const auto i = std::size_t(part);
    const head::Mesh& mesh = head.parts[i];
    const bool moved = !pose.positions[i].empty();
    scene.surfaces.push_back({moved ? pose.positions[i] : rig.parts[i].positions,
                              moved ? pose.normals[i] : rig.parts[i].normals, mesh.colours,
                              mesh.occlusion, mesh.triangles, mesh.surface, pose.transforms[i],
                              mesh.facets, mesh.corners, mesh.materials, head.materials,
                              rig.parts[i].normals, mesh.grain, rig.parts[i].positions});
  }
  return scene;
}

Camera look_at(const head::Head& head, double left_degrees, double up_degrees, double zoom) {
  const double left = left_degrees * std::numbers::pi / 180;
  const double up = up_degrees * std::numbers::pi / 180;
  // Crown to chin fills about two thirds of the picture.
  const double top = crown_of(head) + 1.0;
  const double chin = head::chin_of(head).y;
  const double height = top - chin;
  // Nearer pictures have the face in their middle.
  const double brow = head.point("4.1").exists() ? head.at("4.1").y : 0.35 * head.fapu.es;
  const double face = 0.5 * (brow + chin);
  const double near = head::smooth_step(1.0, 1.8, zoom);
  const double middle = (chin + height * 0.44) * (1 - near) + face * near;
  const double depth = height * (0.16 + 0.16 * near);
  const head::Vec3d target{0, middle, head.neck_pivot.z + depth};
  const head::Vec3d direction{std::sin(left) * std::cos(up), std::sin(up),
                              std::cos(left) * std::cos(up)};
  const double distance = height * 3.4;
  Camera camera;
  camera.target = head::Vec3(target);
  camera.eye = head::Vec3(target + direction * distance);
  camera.view_angle = float(2 * std::atan(0.67 * height / (distance * std::max(zoom, 0.01))));
  return camera;
}

Camera fit_to(Camera camera, int width, int height) {
  constexpr double kNarrow = 0.74;
  const double aspect = double(std::max(width, 1)) / std::max(height, 1);
  if (aspect < kNarrow) {
    camera.view_angle =
        float(2 * std::atan(std::tan(double(camera.view_angle) / 2) * kNarrow / aspect));
  }
  return camera;
}

std::optional<double> view_degrees(std::string_view text) {
  if (text == "front") return 0;
  if (text == "three-quarter") return 35;
  if (text == "side") return 90;
  double degrees = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), degrees);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(degrees)) {
    return std::nullopt;
  }
  return degrees;
}

}  // namespace animeme::render
