#include "tools/characters/crossmap/target_view_internal.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/formats/files/base64.h"
#include "tools/view/render/png.h"
#include "tools/view/render/raster.h"
#include "tools/view/studio/head_view.h"

namespace animeme::crossmap {
namespace {

using head::Vec3;

Result<std::string> address_of(const render::Image& image) {
  const auto png = render::png_of(image);
  if (!png) return png.error();
  return "data:image/png;base64," + tools::base64_of(*png);
}

// What the camera of a mesh looks at: the part that its controls move most.
struct Aim {
  Vec3 middle;
  float size = 1;
};

Aim aim_of(const TargetMesh& mesh) {
  std::vector<float> moved(mesh.vertices.size(), 0.0f);
  for (const MeshControl& control : mesh.controls) {
    const float full = control.high > 2 ? 300.0f : 1.0f;  // FAP units
    for (const auto& [v, move] : control.moves) moved[v] = std::max(moved[v], length(move) * full);
  }
  const float most = *std::max_element(moved.begin(), moved.end());
  Vec3 low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  for (std::size_t v = 0; v < moved.size(); ++v) {
    if (moved[v] < 0.3f * most) continue;
    const Vec3 p = mesh.vertices[v];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return {(low + high) * 0.5f, 1.25f * std::max({high.x - low.x, high.y - low.y, 1e-6f})};
}

}  // namespace

struct TargetView::State {
  explicit State(const Target& target_, int size_)
      : target(target_), size(size_), renderer({.width = size_, .height = size_}) {}

  const Target& target;
  int size;
  std::optional<studio::HeadView> woman;
  render::Renderer renderer;
  Aim aim;
  std::vector<head::Triangle> triangles;
  std::vector<float> open_sky;

  // Meshes of others are wound either way. What of them looks at the camera is their outside.
  void prepare_mesh() {
    const TargetMesh& mesh = *target.mesh;
    aim = aim_of(mesh);
    const float near = 0.5f * aim.size;
    float forward = 0;
    for (const head::Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
      const Vec3 off = a - aim.middle;
      if (std::abs(off.x) < near && std::abs(off.y) < near) forward += cross(b - a, c - a).z;
    }
    triangles = mesh.triangles;
    if (forward < 0) {
      for (head::Triangle& t : triangles) std::swap(t[1], t[2]);
    }
    open_sky.assign(mesh.vertices.size(), 1.0f);
  }

  Result<std::string> draw_mesh(const std::vector<Vec3>& moves) {
    const TargetMesh& mesh = *target.mesh;
    // Ten units wide, before a camera that is made for heads in centimetres.
    const float scale = 10 / aim.size;
    std::vector<Vec3> places(mesh.vertices.size()), normals(mesh.vertices.size());
    for (std::size_t v = 0; v < places.size(); ++v) {
      places[v] = (mesh.vertices[v] + moves[v] - aim.middle) * scale;
    }
    for (const head::Triangle& t : triangles) {
      const Vec3 n = cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
      for (const std::uint32_t v : t) normals[v] += n;
    }
    for (Vec3& n : normals) n = normalised(n);
    render::Scene scene;
    scene.surfaces.push_back({places, normals, mesh.colours, open_sky, triangles,
                              head::Material::skin, head::Transform{}});
    render::Camera camera;
    camera.eye = {0, 0, 60};
    camera.view_angle = float(2 * std::atan(5.0 / 60));
    return address_of(renderer.render(scene, camera));
  }
};

TargetView::TargetView(std::unique_ptr<State> state) : state_(std::move(state)) {}
TargetView::TargetView(TargetView&&) noexcept = default;
TargetView::~TargetView() = default;

Result<TargetView> TargetView::make(const Target& target, int size) {
  auto state = std::make_unique<State>(target, size);
  if (target.mesh) {
    state->prepare_mesh();
  } else if (target.kind != TargetKind::keys &&
             shown_faps(target, target.values.data()).has_value()) {
    studio::HeadLook look;
    look.zoom = 2.4;
    look.width = look.height = size;
    auto woman = studio::HeadView::make(look);
    if (!woman) return woman.error();
    state->woman = std::move(*woman);
  }
  return TargetView(std::move(state));
}

bool TargetView::draws() const { return state_->woman || state_->target.mesh; }

Result<std::string> TargetView::key(std::size_t index, const double* controls) {
  if (state_->target.mesh) return state_->draw_mesh(state_->target.mesh_keys[index]);
  return values(controls);
}

Result<std::string> TargetView::values(const double* controls) {
  const Target& target = state_->target;
  if (target.mesh) {
    std::vector<Vec3> moves(target.mesh->vertices.size());
    for (std::size_t c = 0; c < target.mesh->controls.size(); ++c) {
      for (const auto& [v, move] : target.mesh->controls[c].moves) {
        moves[v] += move * float(controls[c]);
      }
    }
    return state_->draw_mesh(moves);
  }
  if (!state_->woman) return std::string();
  return address_of(state_->woman->draw(shown_faps(target, controls).value_or(fap::Frame{})));
}

}  // namespace animeme::crossmap
