// Files that others have packed: tests/data/heads/packed.
#include "tools/view/gltf/detail/unpack.h"

#include <gmock/gmock.h>

#include "tests/support/shared.h"
#include "tests/view/gltf/square.h"

namespace animeme::gltf {
namespace unpack_test {

using ::testing::HasSubstr;

std::vector<std::uint8_t> packed(const std::string& name) {
  const std::string text = test::data_file("heads/packed/" + name);
  return {text.begin(), text.end()};
}

// Every vertex of one is near one of the other, with its shapes.
void expect_same(const head::Source& is, const head::Source& wanted, bool shapes) {
  ASSERT_EQ(is.pieces.size(), 1u);
  ASSERT_EQ(is.pieces[0].mesh.positions.size(), wanted.pieces[0].mesh.positions.size());
  EXPECT_EQ(is.pieces[0].mesh.triangles.size(), wanted.pieces[0].mesh.triangles.size());
  EXPECT_EQ(is.shapes.size(), shapes ? wanted.shapes.size() : 0u);
  ASSERT_GE(wanted.shapes.size(), 2u);
  // 14 bits of 16 cm, and of a way of 2 cm.
  for (const head::Vec3 p : wanted.pieces[0].mesh.positions) {
    double nearest = 1e9;
    for (const head::Vec3 q : is.pieces[0].mesh.positions) {
      nearest = std::min(nearest, double(length(q - p)));
    }
    ASSERT_LT(nearest, 2e-5);
  }
  if (!shapes) return;
  EXPECT_EQ(is.targets.size(), wanted.targets.size());
  for (std::size_t i = 0; i < std::min(is.shapes.size(), wanted.shapes.size()); ++i) {
    EXPECT_EQ(is.shapes[i].name, wanted.shapes[i].name);
  }
}

TEST(Unpack, WhatOthersHavePacked) {
  const head::Source plain = read(packed("plain.glb"));
  if (can_unpack_meshopt()) expect_same(read(packed("meshopt.glb")), plain, true);
  if (can_unpack_draco()) {
    expect_same(read(packed("draco_sequential.glb")), plain, true);
    expect_same(read(packed("draco_edgebreaker.glb")), plain, false);
  }
  if (!can_unpack_draco()) {
    EXPECT_THAT(error_of(packed("draco_sequential.glb")).message, HasSubstr("libdraco-dev"));
  }
  if (!can_unpack_meshopt()) {
    EXPECT_THAT(error_of(packed("meshopt.glb")).message, HasSubstr("libmeshoptimizer-dev"));
  }
}

// Each byte of the packed data in turn is another: read or refused, never more.
TEST(Unpack, DamagedOnes) {
  std::size_t refused = 0, read_all = 0;
  for (const char* name : {"meshopt.glb", "draco_sequential.glb", "draco_edgebreaker.glb"}) {
    const std::vector<std::uint8_t> whole = packed(name);
    const std::size_t json = 20 + std::size_t(whole[12] + 256 * whole[13]);
    for (std::size_t at = json + 8; at < whole.size(); at += 3) {
      std::vector<std::uint8_t> damaged = whole;
      damaged[at] = std::uint8_t(damaged[at] ^ (at % 2 == 0 ? 0xFF : 0x11));
      const auto source = read_head(damaged);
      ++(source ? read_all : refused);
    }
  }
  EXPECT_GT(refused, 20u);
  EXPECT_GT(read_all, 20u) << "places are others, but places";
}

std::vector<std::uint8_t> claiming(const std::string& name, const std::string& was,
                                   const std::string& is) {
  std::vector<std::uint8_t> file = packed(name);
  EXPECT_EQ(was.size(), is.size());
  const auto at = std::search(file.begin(), file.end(), was.begin(), was.end());
  EXPECT_NE(at, file.end()) << was;
  if (at != file.end()) std::copy(is.begin(), is.end(), at);
  return file;
}

TEST(Unpack, ClaimsAreNotBelieved) {
  if (can_unpack_meshopt()) {
    const auto error = [](const std::string& was, const std::string& is) {
      return error_of(claiming("meshopt.glb", was, is)).message;
    };
    EXPECT_THAT(error("\"byteStride\":2,\"count\":216", "\"byteStride\":3,\"count\":216"),
                HasSubstr("indices of 3 bytes"));
    EXPECT_THAT(error("\"byteLength\":95,", "\"byteLength\":1 ,"), HasSubstr("too short"));
    EXPECT_THAT(error("\"TRIANGLES\"", "\"TRIANGLED\""), HasSubstr("\"TRIANGLED\""));
  }
  if (can_unpack_draco()) {
    // The data says 72 triangles and 49 vertices; now 127.
    auto file = packed("draco_sequential.glb");
    const std::string magic = "DRACO";
    const auto at = std::search(file.begin(), file.end(), magic.begin(), magic.end());
    ASSERT_NE(at, file.end());
    *(at + 11) = 127;
    EXPECT_THAT(error_of(file).message, HasSubstr("more vertices or triangles"));
    EXPECT_THAT(error_of(claiming("draco_sequential.glb", "\"TEXCOORD_0\":1}", "\"TEXCOORD_0\":9}"))
                    .message,
                HasSubstr("TEXCOORD_0"));
  }
}

}  // namespace unpack_test
}  // namespace animeme::gltf
