// What tests of reading share: a square to begin with, and what is read.
#pragma once

#include <gmock/gmock.h>

#include "tests/support/gltf_writer.h"
#include "tests/support/png_writer.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

inline head::Source read(const std::vector<std::uint8_t>& file, const ReadOptions& options = {}) {
  auto source = read_head(file, options);
  EXPECT_TRUE(source) << source.error().describe();
  return source ? std::move(*source) : head::Source{};
}

inline Error error_of(const std::vector<std::uint8_t>& file) {
  auto source = read_head(file);
  EXPECT_FALSE(source);
  return source ? Error{} : source.error();
}

inline void expect_near(head::Vec3 is, head::Vec3 wanted, float tolerance = 1e-5f) {
  EXPECT_NEAR(is.x, wanted.x, tolerance);
  EXPECT_NEAR(is.y, wanted.y, tolerance);
  EXPECT_NEAR(is.z, wanted.z, tolerance);
}

// A square of two triangles, 0..1 in x and y.
struct Square {
  test::GltfWriter file;
  nlohmann::json primitive;

  Square() {
    primitive["attributes"]["POSITION"] =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    primitive["indices"] = file.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
  }
  void add_uvs(const std::vector<float>& uvs = {0, 1, 1, 1, 1, 0, 0, 0}) {
    primitive["attributes"]["TEXCOORD_0"] = file.accessor(uvs, "VEC2");
  }
  // 4 x 4 texels, the left half red, the right half green.
  void add_texture(nlohmann::json info = {{"index", 0}},
                   nlohmann::json material = nlohmann::json::object()) {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 16; ++i) {
      const bool left = i % 4 < 2;
      texels.insert(texels.end(), {std::uint8_t(left ? 255 : 0), std::uint8_t(left ? 0 : 255), 0,
                                   std::uint8_t(left ? 255 : 0)});
    }
    file.add("images", {{"uri", test::GltfWriter::data_uri(test::png_of(texels, 4), "image/png")}});
    file.add("textures", {{"source", 0}});
    material["pbrMetallicRoughness"]["baseColorTexture"] = std::move(info);
    primitive["material"] = file.add("materials", std::move(material));
  }
  std::vector<std::uint8_t> glb(nlohmann::json node = nlohmann::json::object()) {
    node["mesh"] =
        file.add("meshes", {{"primitives", nlohmann::json::array({primitive})}, {"name", "face"}});
    file.add("scenes", {{"nodes", {file.add("nodes", std::move(node))}}});
    return file.glb();
  }
};

}  // namespace animeme::gltf
