#include "tools/view/viewer/detail/coats.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace animeme::viewer::detail {
namespace {

using head::Coat;
using head::Corner;
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

// Pictures by their files: one may be worn as a colour and as values.
class Wardrobe {
 public:
  explicit Wardrobe(Bytes& out) : out_(out) {}

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

Json coat_of(const Coat& coat, Wardrobe& wardrobe) {
  return {{"shading", kShadings[std::size_t(coat.shading)]},
          {"alpha", kAlphaModes[std::size_t(coat.alpha_mode)]},
          {"cutoff", coat.cutoff},
          {"double", coat.double_sided},
          {"plain", coat.vertex_colours},
          {"factor", {coat.factor.rgb.x, coat.factor.rgb.y, coat.factor.rgb.z, coat.factor.alpha}},
          {"normal_scale", coat.normal_scale},
          {"metallic", coat.metallic},
          {"roughness", coat.roughness},
          {"specular", coat.specular},
          {"strength", coat.occlusion_strength},
          {"emission", numbers_of(coat.emission)},
          {"shade", numbers_of(coat.shade)},
          {"shift", coat.shade_shift},
          {"toony", coat.toony},
          {"rim", numbers_of(coat.rim)},
          {"rim_power", coat.rim_power},
          {"rim_lift", coat.rim_lift},
          {"textures",
           {{"base", wardrobe.texture(coat.base)},
            {"normal", wardrobe.texture(coat.normal)},
            {"metal", wardrobe.texture(coat.metal_rough)},
            {"occlusion", wardrobe.texture(coat.occlusion)},
            {"emissive", wardrobe.texture(coat.emissive)},
            {"shade", wardrobe.texture(coat.shade_texture)}}}};
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
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return mesh.coats[a] < mesh.coats[b]; });
  Json runs = Json::array();
  last = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint16_t coat = mesh.coats[order[i]];
    if (i == 0 || coat != mesh.coats[order[i - 1]]) runs.push_back({coat, 0});
    runs.back()[1] = runs.back()[1].get<std::size_t>() + 1;
    for (const std::uint32_t corner : mesh.facets[order[i]]) {
      out.zigzag(std::int64_t(corner) - last);
      last = corner;
    }
  }
  info["runs"] = std::move(runs);
  return info;
}

Json write_coats(std::span<const Coat> coats, Bytes& out) {
  Wardrobe wardrobe(out);
  Json list = Json::array();
  for (const Coat& coat : coats) list.push_back(coat_of(coat, wardrobe));
  return {{"coats", std::move(list)}, {"pictures", wardrobe.take()}};
}

}  // namespace animeme::viewer::detail
