#include "tools/view/gltf/detail/extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "tools/view/gltf/detail/unpack.h"

namespace animeme::gltf {
namespace {

constexpr std::string_view kDraco = "KHR_draco_mesh_compression";
constexpr std::array<std::string_view, 2> kMeshopt = {"EXT_meshopt_compression",
                                                      "KHR_meshopt_compression"};

// Those that change what is read here, which is done, and those that change light or pictures
// alone, which are not looked at.
constexpr std::array<std::string_view, 26> kKnownExtensions = {
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_materials_unlit",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_ior",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_variants",
    "KHR_lights_punctual",
    "KHR_texture_basisu",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "MSFT_texture_dds",
    "VRM",
    "VRMC_vrm",
    "VRMC_materials_mtoon",
    "VRMC_springBone",
    "KHR_node_visibility",
    "KHR_animation_pointer"};

bool is_meshopt(std::string_view name) {
  return std::find(kMeshopt.begin(), kMeshopt.end(), name) != kMeshopt.end();
}

}  // namespace

Error compressed_error(const std::string& what) {
  if (what == kDraco) {
    return make_error(
        Code::unsupported,
        "the meshes are compressed by Draco, which this build cannot read: export them without "
        "compression (in Blender: Export glTF 2.0, switch Compression off), or build with the "
        "Debian package libdraco-dev");
  }
  return make_error(
      Code::unsupported,
      "the meshes are compressed by meshopt, which this build cannot read: export them "
      "without compression (gltfpack: without -c and -cc), or build with the Debian "
      "package libmeshoptimizer-dev");
}

Result<void> check_extensions(const Json& root) {
  for (const Json& entry : list(root, "extensionsRequired")) {
    const std::string name = text_or(entry);
    if (name == kDraco ? can_unpack_draco() : is_meshopt(name) && can_unpack_meshopt()) continue;
    if (name == kDraco || is_meshopt(name)) return compressed_error(name);
    if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) ==
        kKnownExtensions.end()) {
      return make_error(Code::unsupported, "the file requires the glTF extension \"" + name +
                                               "\", which is not supported: export it without");
    }
  }
  return {};
}

bool is_fallback_buffer(const Json& buffer) {
  return std::any_of(kMeshopt.begin(), kMeshopt.end(), [&](std::string_view name) {
    return is_true(member(buffer, "extensions", std::string(name).c_str(), "fallback"));
  });
}

const Json& meshopt_of(const Json& view) {
  for (const std::string_view name : kMeshopt) {
    const Json& found = member(view, "extensions", std::string(name).c_str());
    if (found.is_object()) return found;
  }
  return member(view, "");
}

bool is_compressed(const Json& entry) {
  const Json& extensions = member(entry, "extensions");
  if (!extensions.is_object()) return false;
  return extensions.contains(kDraco) || extensions.contains(kMeshopt[0]) ||
         extensions.contains(kMeshopt[1]);
}

}  // namespace animeme::gltf
