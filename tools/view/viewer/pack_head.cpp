#include <algorithm>
#include <cmath>

#include "fap/head/srgb.h"
#include "fap/tables.h"
#include "tools/formats/common/json.h"
#include "tools/view/render/scene.h"
#include "tools/view/viewer/detail/bytes.h"
#include "tools/view/viewer/detail/materials.h"
#include "tools/view/viewer/rig/packed_rig.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::viewer {
namespace {

using detail::Bytes;
using head::Vec3;
using tools::Json;

constexpr const char* kMaterials[] = {"skin", "eye", "teeth", "wet", "hair", "cloth"};

Json json_of(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

float axis(Vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

std::uint32_t rounded(float value, float top) {
  return std::uint32_t(std::lround(std::clamp(value, 0.0f, top)));
}

// 0..255, as sRGB.
std::uint32_t shown(float light) {
  const double v = std::clamp(double(light), 0.0, 1.0);
  return std::uint32_t(std::lround(255 * head::srgb_of_linear(v)));
}

// What is drawn; where it is stands in the packed rig.
Json write_part(const head::Mesh& mesh, std::string_view name, Bytes& out) {
  Json part{{"name", name},
            {"surface", kMaterials[std::size_t(mesh.surface)]},
            {"solid", mesh.triangles.size()}};  // further ones bear on normals alone
  for (int k = 0; k < 3; ++k) {
    for (const Vec3 c : mesh.colours) out.u8(shown(axis(c, k)));
  }
  for (const float sky : mesh.occlusion) out.u8(rounded(sky * 255, 255));
  part["grain"] = !mesh.grain.empty();
  for (const head::Grain& g : mesh.grain) out.u8(rounded(127 * g.relief + 128, 255));
  for (const head::Grain& g : mesh.grain) out.u8(rounded(127 * g.gloss, 255));
  if (Json facets = detail::write_facets(mesh, out); !facets.is_null()) {
    part["facets"] = std::move(facets);
  }
  return part;
}

Json points_of(const head::Head& head) {
  Json points = Json::array();
  for (std::size_t i = 0; i < head.feature_points.size(); ++i) {
    const head::FeaturePoint& point = head.feature_points[i];
    if (!point.exists()) continue;
    const fap::FeaturePointInfo& info = fap::kFeaturePoints[i];
    points.push_back({{"id", info.id},
                      {"name", info.name},
                      {"part", int(point.part)},
                      {"vertex", point.vertex}});
  }
  return points;
}

Json camera_of(const head::Head& head) {
  const render::Camera camera = render::look_at(head, 0);
  // Nearer pictures look at another place; from 1.8 on it stays.
  return {{"target", json_of(camera.target)},
          {"near", json_of(render::look_at(head, 0, 0, 1.8).target)},
          {"distance", length(camera.eye - camera.target)},
          {"angle", camera.view_angle}};
}

}  // namespace

std::vector<std::uint8_t> pack_head(const head::Head& head, const head::Rig& rig) {
  const std::vector<std::uint8_t> packed = detail::pack_rig(rig);
  Bytes data;
  data.append(packed);
  Json parts = Json::array();
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    parts.push_back(write_part(head.parts[i], head::kPartNames[i], data));
  }
  Json header{{"version", 5},
              {"name", head.name},
              {"rig", packed.size()},
              {"controls", head::kFirstShape + rig.shapes.size()},
              {"parts", parts},
              {"points", points_of(head)},
              {"camera", camera_of(head)}};
  if (!head.materials.empty()) header.update(detail::write_materials(head.materials, data));
  return detail::with_header(header, data);
}

}  // namespace animeme::viewer
