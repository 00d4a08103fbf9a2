// How much of a texture is seen when a mesh has colours at its vertices alone.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "fap/head/srgb.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/png_writer.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace painted_face_test {

using head::Vec3;

constexpr int kTexels = 1024;
constexpr int kCells = 70;  // 5041 vertices, 2.9 mm apart on a face of 20 cm

// A face of 20 cm: brows with hairs, lips with a sharp border, spots, everything else smooth.
Vec3 painted(float x, float y) {
  Vec3 colour = Vec3{0.80f, 0.55f, 0.45f} * (1 - 0.3f * (x * x + y * y));
  const float side = std::abs(x);
  const float brow = std::abs(y - 0.35f + 0.3f * (side - 0.4f) * (side - 0.4f));
  if (side > 0.15f && side < 0.65f && brow < 0.04f) {
    const float hair = 0.5f + 0.5f * std::sin(300 * side + 60 * y);
    colour = colour * (0.35f + 0.25f * hair);
  }
  const float lips = (x / 0.28f) * (x / 0.28f) + ((y + 0.5f) / 0.09f) * ((y + 0.5f) / 0.09f);
  if (lips < 1) colour = {0.65f, 0.22f, 0.22f};
  if (lips < 1 && std::abs(y + 0.5f) < 0.006f) colour = {0.25f, 0.08f, 0.08f};
  for (int i = 0; i < 12; ++i) {
    const float dx = x - 0.6f * std::sin(float(5 * i)), dy = y + 0.3f * std::cos(float(7 * i));
    if (dx * dx + dy * dy < 0.00015f) colour = colour * 0.7f;
  }
  return colour;  // sRGB
}

// The uv plane is the face: x = 2u - 1, y = 1 - 2v.
std::vector<std::uint8_t> face_file() {
  std::vector<std::uint8_t> texels;
  for (int row = 0; row < kTexels; ++row) {
    for (int column = 0; column < kTexels; ++column) {
      const Vec3 c = painted((float(column) + 0.5f) / (kTexels / 2) - 1,
                             1 - (float(row) + 0.5f) / (kTexels / 2));
      for (const float part : {c.x, c.y, c.z}) {
        texels.push_back(std::uint8_t(std::lround(255 * part)));
      }
      texels.push_back(255);
    }
  }
  test::GltfWriter file;
  std::vector<float> places, uvs;
  std::vector<std::uint32_t> corners;
  for (int row = 0; row <= kCells; ++row) {
    for (int column = 0; column <= kCells; ++column) {
      const float u = float(column) / kCells, v = float(row) / kCells;
      places.insert(places.end(), {20 * u - 10, 10 - 20 * v, 0});
      uvs.insert(uvs.end(), {u, v});
      if (row == kCells || column == kCells) continue;
      const auto a = std::uint32_t(row * (kCells + 1) + column);
      corners.insert(corners.end(),
                     {a, a + kCells + 1, a + 1, a + 1, a + kCells + 1, a + kCells + 2});
    }
  }
  const int view = file.view(test::png_of(texels, kTexels));
  file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.add("meshes", {{"primitives",
                       {{{"attributes",
                          {{"POSITION", file.accessor(places, "VEC3")},
                           {"TEXCOORD_0", file.accessor(uvs, "VEC2")}}},
                         {"indices", file.accessor(corners, "SCALAR")},
                         {"material", 0}}}}});
  file.add("nodes", {{"mesh", 0}, {"name", "face"}});
  return file.glb();
}

// Draws the colours of the vertices over the plane and compares: root mean square of 255 steps.
double error_of(const head::Mesh& mesh) {
  constexpr int kPixels = 512;
  double sum = 0;
  int count = 0;
  for (const head::Triangle& t : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = (mesh.positions[t[i]] + Vec3{10, 10, 0}) * (kPixels / 20.0f);
    }
    const float area = head::cross(p[1] - p[0], p[2] - p[0]).z;
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
    for (int y = int(low); y <= int(high); ++y) {
      for (int x = int(left); x <= int(right); ++x) {
        const Vec3 q{float(x) + 0.5f, float(y) + 0.5f, 0};
        const float a = head::cross(p[1] - q, p[2] - q).z / area;
        const float b = head::cross(p[2] - q, p[0] - q).z / area;
        if (a < 0 || b < 0 || a + b > 1) continue;
        const Vec3 is =
            mesh.colours[t[0]] * a + mesh.colours[t[1]] * b + mesh.colours[t[2]] * (1 - a - b);
        const Vec3 wanted = painted(q.x / (kPixels / 2) - 1, q.y / (kPixels / 2) - 1);
        const Vec3 off = head::srgb_of_linear(is) - wanted;
        sum += double(head::dot(off, off)) / 3;
        ++count;
      }
    }
  }
  return 255 * std::sqrt(sum / count);
}

TEST(PaintedFace, DividedTrianglesShowTheTexture) {
  const std::vector<std::uint8_t> file = face_file();
  std::vector<double> errors;
  for (const std::size_t vertices : {0, 10000, 20000, 40000, 60000}) {
    const auto start = std::chrono::steady_clock::now();
    const auto source = read_head(file, {.vertices = vertices});
    ASSERT_TRUE(source) << source.error().describe();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    const head::Mesh& mesh = source->pieces.at(0).mesh;
    errors.push_back(error_of(mesh));
    std::printf("up to %5zu vertices: %5zu, off by %.2f of 255, %.2f s\n", vertices,
                mesh.positions.size(), errors.back(), time.count());
  }
  EXPECT_LT(errors[2], 0.5 * errors[0]);
  EXPECT_LE(errors[4], errors[2]);
}

}  // namespace painted_face_test
}  // namespace animeme::gltf
