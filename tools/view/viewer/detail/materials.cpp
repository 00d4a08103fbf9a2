#include "tools/view/viewer/detail/materials.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace animeme::viewer::detail {
namespace {

using head::Corner;
using head::Material;
using head::Vec3;
using tools::Json;

constexpr const char* kShadings[] = {"lit", "unlit", "toon"};
constexpr const char* kAlphaModes[] = {"opaque", "mask", "blend"};
constexpr const char* kWraps[] = {"repeat", "clamp", "mirror"};

Json numbers_of(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

Json write_uvs(const std::vector<Corner>& corners, float head::Uv::*axis, Bytes& out) {
  float low = corners[0].uv.*axis, high = low;
  for (const Corner& corner : corners) {
    low = std::min(low, corner.uv.*axis);
    high = std::max(high, corner.uv.*axis);
  }
  const float step = std::max(high - low, 1e-6f) / 65535;
  for (const Corner& corner : corners) {
    out.u16(std::uint32_t(std::lround((corner.uv.*axis - low) / step)));
  }
  return Json::array({low, step});
}

// Pictures by their files: one may hold colours and values.
class PictureTable {
 public:
  explicit PictureTable(Bytes& out) : out_(out) {}

  Json texture(const head::Texture& texture) {
    if (!texture || texture.picture->file().empty()) return nullptr;
    const head::Picture& picture = *texture.picture;
    auto found = std::find_if(worn_.begin(), worn_.end(), [&](const head::Picture* other) {
      return other == &picture || other->file() == picture.file();
    });
    if (found == worn_.end()) {
      found = worn_.insert(found, &picture);
      pictures_.push_back({{"type", picture.type()}, {"bytes", picture.file().size()}});
      for (const std::uint8_t byte : picture.file()) out_.u8(byte);
    }
    return Json::array({found - worn_.begin(), picture.kind() == head::TexelKind::colour,
                        kWraps[std::size_t(texture.wrap_u)], kWraps[std::size_t(texture.wrap_v)]});
  }

  Json take() { return std::move(pictures_); }

 private:
  Bytes& out_;
  std::vector<const head::Picture*> worn_;
  Json pictures_ = Json::array();
};

Json material_of(const Material& material, PictureTable& pictures) {
  return {{"shading", kShadings[std::size_t(material.shading)]},
          {"alpha", kAlphaModes[std::size_t(material.alpha_mode)]},
          {"cutoff", material.cutoff},
          {"double", material.double_sided},
          {"plain", material.vertex_colours},
          {"factor",
           {material.factor.rgb.x, material.factor.rgb.y, material.factor.rgb.z,
            material.factor.alpha}},
          {"normal_scale", material.normal_scale},
          {"metallic", material.metallic},
          {"roughness", material.roughness},
          {"specular", material.specular},
          {"strength", material.occlusion_strength},
          {"emission", numbers_of(material.emission)},
          {"shade", numbers_of(material.shade)},
          {"shift", material.shade_shift},
          {"toony", material.toony},
          {"rim", numbers_of(material.rim)},
          {"rim_power", material.rim_power},
          {"rim_lift", material.rim_lift},
          {"textures",
           {{"base", pictures.texture(material.base)},
            {"normal", pictures.texture(material.normal)},
            {"metal", pictures.texture(material.metal_rough)},
            {"occlusion", pictures.texture(material.occlusion)},
            {"emissive", pictures.texture(material.emissive)},
            {"shade", pictures.texture(material.shade_texture)}}}};
}

}  // namespace

Json write_facets(const head::Mesh& mesh, Bytes& out) {
  if (mesh.facets.empty()) return nullptr;
  std::int64_t last = 0;
  for (const Corner& corner : mesh.corners) {
    out.zigzag(std::int64_t(corner.vertex) - last);
    last = corner.vertex;
  }
  Json info{{"corners", mesh.corners.size()},
            {"u", write_uvs(mesh.corners, &head::Uv::u, out)},
            {"v", write_uvs(mesh.corners, &head::Uv::v, out)}};
  for (float Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    for (const Corner& corner : mesh.corners) {
      const float part = std::clamp(corner.normal.*axis, -1.0f, 1.0f);
      out.u16(std::uint32_t(std::lround(32767 * part)) & 0xFFFF);
    }
  }
  const bool tinted = std::any_of(mesh.corners.begin(), mesh.corners.end(),
                                  [](const Corner& c) { return c.tint != Corner{}.tint; });
  info["tinted"] = tinted;
  for (std::size_t k = 0; k < 4 && tinted; ++k) {
    for (const Corner& corner : mesh.corners) out.u8(corner.tint[k]);
  }
  std::vector<std::size_t> order(mesh.facets.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mesh.materials[a] < mesh.materials[b];
  });
  Json runs = Json::array();
  last = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint16_t material = mesh.materials[order[i]];
    if (i == 0 || material != mesh.materials[order[i - 1]]) runs.push_back({material, 0});
    runs.back()[1] = runs.back()[1].get<std::size_t>() + 1;
    for (const std::uint32_t corner : mesh.facets[order[i]]) {
      out.zigzag(std::int64_t(corner) - last);
      last = corner;
    }
  }
  info["runs"] = std::move(runs);
  return info;
}

Json write_materials(std::span<const Material> materials, Bytes& out) {
  PictureTable pictures(out);
  Json list = Json::array();
  for (const Material& material : materials) list.push_back(material_of(material, pictures));
  return {{"materials", std::move(list)}, {"pictures", pictures.take()}};
}

}  // namespace animeme::viewer::detail
