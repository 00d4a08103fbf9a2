// What Xface's player takes for granted of its files, which any XML or VRML reader would not mind.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "fap/xml/detail/document.h"
#include "fap/xml/fdp.h"
#include "tests/head/head_support.h"

namespace animeme::test {
namespace fdp_player_test {

const head::FdpFiles& child_files() {
  static const head::FdpFiles files =
      *head::write_fdp(head_of("child"), rig_of("child"), {.name = "child", .scale = 1});
  return files;
}

// A scanner that knows blanks only: numbers, each followed by a word that is ',' or ']'.
struct PlainMesh {
  std::vector<head::Vec3> points;
  std::vector<head::Triangle> triangles, on_texture;
  std::size_t places = 0;  // on the texture
  std::string texture;
};

std::vector<PlainMesh> scan(const std::string& text) {
  std::istringstream in(text);
  std::vector<PlainMesh> meshes;
  std::string word, texture;
  bool coordinates = false;
  while (in >> word) {
    if (word == "geometry") {
      in >> word;
      EXPECT_EQ(word, "IndexedFaceSet");  // a DEF would replace the meshes of other files
      in >> word;
      EXPECT_EQ(word, "{");
      meshes.emplace_back();
      meshes.back().texture = texture;
    }
    if (word == "texture") {
      in >> word;
      EXPECT_EQ(word, "ImageTexture");
      while (word != "url") in >> word;
      in >> texture;
    }
    if (word == "texCoord") {
      while (word != "[") in >> word;
      for (float u = 0, v = 0; in && word != "]"; ++meshes.back().places) {
        in >> u >> v >> word;
        EXPECT_TRUE(u >= 0.25f && u <= 0.75f && v >= 0.25f && v <= 0.75f) << u << " " << v;
      }
    }
    coordinates = coordinates || word == "coord";
    if (word == "point" && coordinates) {
      in >> word;
      EXPECT_EQ(word, "[");
      while (in && word != "]") {
        head::Vec3 p;
        in >> p.x >> p.y >> p.z >> word;
        meshes.back().points.push_back(p);
      }
      coordinates = false;
    }
    if (word == "coordIndex" || word == "texCoordIndex") {
      auto& triangles = word == "coordIndex" ? meshes.back().triangles : meshes.back().on_texture;
      in >> word;
      EXPECT_EQ(word, "[");
      while (in && word != "]") {
        std::array<long, 4> n{};
        for (long& x : n) in >> x >> word;
        EXPECT_EQ(n[3], -1);
        triangles.push_back({std::uint32_t(n[0]), std::uint32_t(n[1]), std::uint32_t(n[2])});
      }
    }
  }
  return meshes;
}

TEST(FdpPlayer, MeshesAreCutAtBlanks) {
  EXPECT_EQ(child_files().wrl.rfind("#VRML V2.0", 0), 0u);
  const std::vector<PlainMesh> meshes = scan(child_files().wrl);
  std::size_t m = 0;
  for (const head::Mesh& mesh : head_of("child").parts) {
    if (mesh.triangles.empty()) continue;
    ASSERT_LT(m, meshes.size());
    EXPECT_EQ(meshes[m].points, mesh.positions);
    EXPECT_EQ(meshes[m].triangles, mesh.triangles);
    // A place for each vertex, by the same numbers: Xface has no others.
    EXPECT_EQ(meshes[m].places, mesh.positions.size());
    EXPECT_EQ(meshes[m].on_texture, mesh.triangles);
    EXPECT_EQ(meshes[m].texture, '"' + child_files().textures.at(m).name + '"');
    ++m;
  }
  EXPECT_EQ(m, meshes.size());
}

TEST(FdpPlayer, TheXmlIsAsItsLoaderWantsIt) {
  const auto root = head::detail::parse_xml(child_files().fdp);
  ASSERT_TRUE(root) << root.error().describe();
  EXPECT_EQ(root->name, "xfdp");
  int heads = 0;
  int sources = 0;
  for (const auto& child : root->children) {
    heads += child.name == "head" ? 1 : 0;
    sources += child.name == "source" ? 1 : 0;
    if (child.name != "fdp") continue;
    ASSERT_TRUE(child.attribute("affects")->starts_with("child.wrl_"));
    const auto* indices = child.child("indices");
    if (indices == nullptr) {
      EXPECT_EQ(child.child("influence"), nullptr);  // a region of nothing would be NaN
      continue;
    }
    // Cut at single blanks; a region of one vertex would be NaN.
    EXPECT_EQ(indices->text.find_first_not_of("0123456789 "), std::string::npos);
    EXPECT_EQ(indices->text.find("  "), std::string::npos);
    EXPECT_GT(std::count(indices->text.begin(), indices->text.end(), ' '), 1);
  }
  ASSERT_EQ(heads, 1);
  ASSERT_EQ(sources, 1);
  EXPECT_EQ(*root->child("head")->child("file")->attribute("version"), "0.2");
  const auto* rest = root->child("source")->child("entity");
  ASSERT_NE(rest, nullptr);
  EXPECT_EQ(*rest->attribute("alias"), "Rest");
  EXPECT_EQ(*rest->child("mesh")->attribute("file"), "child.wrl");
  for (const auto& bind : rest->children) {
    const std::string* item = bind.attribute("item");
    if (item == nullptr || *item != "LeftEye") continue;
    EXPECT_FLOAT_EQ(std::stof(*bind.attribute("pivotX")), -head_of("child").eyes[0].centre.x);
  }
}

}  // namespace fdp_player_test
}  // namespace animeme::test
