// Visemes and expressions of Xface files: whole meshes that its player finds by their aliases and
// pairs with those of the entity Rest by their order.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "fap/head/shapes.h"
#include "fap/head/wrl.h"
#include "fap/xml/detail/document.h"
#include "fap/xml/fdp.h"
#include "tests/head/head_support.h"

namespace animeme::test {
namespace fdp_keyframes_test {

using head::Piece;
using head::Vec3;

const head::FdpFiles& child_files() {
  static const head::FdpFiles files =
      *head::write_fdp(head_of("child"), rig_of("child"), {.name = "child", .keyframes = true});
  return files;
}

Result<std::string> load(const std::string& name) {
  if (name == "child.wrl") return child_files().wrl;
  for (const head::FdpTexture& file : child_files().keyframes)
    if (file.name == name) return file.content;
  return make_error(Code::not_found, "there is no file " + name);
}

struct Entity {
  std::string category;
  std::vector<Piece> pieces;
};

// What the player loads: entities by alias.
const std::map<std::string, Entity>& entities() {
  static const std::map<std::string, Entity> all = [] {
    std::map<std::string, Entity> out;
    const auto root = head::detail::parse_xml(child_files().fdp);
    EXPECT_TRUE(root) << root.error().describe();
    std::map<std::string, std::vector<Piece>> meshes;  // each file is read once
    for (const head::detail::XmlElement& entity : root->child("source")->children) {
      Entity& made = out[*entity.attribute("alias")];
      made.category = *entity.attribute("category");
      for (const head::detail::XmlElement& mesh : entity.children) {
        if (mesh.name != "mesh") continue;
        const std::string& file = *mesh.attribute("file");
        if (meshes.count(file) == 0) {
          const auto text = load(file);
          EXPECT_TRUE(text) << text.error().describe();
          auto pieces = head::read_wrl(*text);
          EXPECT_TRUE(pieces) << file << ": " << pieces.error().describe();
          meshes[file] = std::move(*pieces);
        }
        const auto& pieces = meshes[file];
        made.pieces.insert(made.pieces.end(), pieces.begin(), pieces.end());
      }
    }
    return out;
  }();
  return all;
}

// The table of fap/head/face_models.md.
const std::map<int, std::string> kVisemes = {
    {1, "b"}, {2, "f"}, {3, "th"},   {4, "d"},   {5, "k"},  {6, "ch"},  {7, "d"},
    {8, "n"}, {9, "r"}, {10, "aah"}, {11, "eh"}, {12, "i"}, {13, "oh"}, {14, "q"}};
const std::map<int, std::string> kExpressions = {
    {1, "SmileClosed"}, {2, "Sad"}, {3, "Anger"}, {4, "Fear"}, {5, "Disgust"}, {6, "Surprise"}};

float length(Vec3 v) { return std::sqrt(head::dot(v, v)); }

// Millimetres: how far the mesh of an entity is from a pose of the rig, and how far it moves.
struct Measured {
  float error = 0, motion = 0;
};

Measured measure(const Entity& entity, const fap::Frame& face) {
  const head::Pose pose = head::pose(rig_of("child"), face);
  const auto& rest = entities().at("Rest").pieces;
  Measured out;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Piece& piece = entity.pieces[i];
    const std::size_t p = std::size_t(*head::part_by_name(piece.name, piece.material));
    const auto& shape = rig_of("child").parts[p].positions;
    const auto& to = pose.positions[p].empty() ? shape : pose.positions[p];
    EXPECT_EQ(to.size(), piece.mesh.positions.size());
    for (std::size_t v = 0; v < std::min(to.size(), piece.mesh.positions.size()); ++v) {
      const Vec3 wanted = pose.transforms[p](to[v]) * 10.0f;
      out.error = std::max(out.error, length(piece.mesh.positions[v] - wanted));
      const Vec3 by = piece.mesh.positions[v] - rest[i].mesh.positions[v];
      out.motion = std::max(out.motion, length(by));
    }
  }
  return out;
}

TEST(FdpKeyframes, EveryVisemeAndExpressionIsAnEntity) {
  const auto& all = entities();
  EXPECT_EQ(all.size(), 1u + 13 + 6);
  for (const auto& [number, alias] : kVisemes) {
    ASSERT_EQ(all.count(alias), 1u) << alias;
    EXPECT_EQ(all.at(alias).category, "Viseme");
  }
  for (const auto& [number, alias] : kExpressions) {
    ASSERT_EQ(all.count(alias), 1u) << alias;
    EXPECT_EQ(all.at(alias).category, "Expression");
  }
}

// Xface stops (or worse) where two meshes differ in their vertices.
TEST(FdpKeyframes, MeshesArePairedInOrder) {
  const auto& rest = entities().at("Rest").pieces;
  EXPECT_GE(rest.size(), 8u);
  for (const auto& [alias, entity] : entities()) {
    ASSERT_EQ(entity.pieces.size(), rest.size()) << alias;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      EXPECT_EQ(entity.pieces[i].name, rest[i].name) << alias;
      EXPECT_EQ(entity.pieces[i].mesh.positions.size(), rest[i].mesh.positions.size()) << alias;
      EXPECT_EQ(entity.pieces[i].mesh.triangles, rest[i].mesh.triangles) << alias;
    }
  }
}

TEST(FdpKeyframes, TheFaceMovesAsInTheRig) {
  for (const auto& [number, alias] : kVisemes) {
    if (number == 7) continue;  // shown by the mesh of 4
    const Measured found = measure(entities().at(alias), head::viseme_shape(number));
    EXPECT_LT(found.error, 0.011f) << alias;
    EXPECT_GT(found.motion, 0.5f) << alias;
  }
  for (const auto& [number, alias] : kExpressions) {
    const Measured found = measure(entities().at(alias), head::expression_shape(number));
    EXPECT_LT(found.error, 0.011f) << alias;
    EXPECT_GT(found.motion, 1.0f) << alias;
  }
}

TEST(FdpKeyframes, TheHeadIsReadAsWithoutThem) {
  const auto source = head::read_fdp(child_files().fdp, load);
  ASSERT_TRUE(source) << source.error().describe();
  const auto plain = head::write_fdp(head_of("child"), rig_of("child"), {.name = "child"});
  ASSERT_TRUE(plain && plain->keyframes.empty());
  const auto from_plain = head::read_fdp(
      plain->fdp, [&](const std::string&) -> Result<std::string> { return plain->wrl; });
  ASSERT_TRUE(from_plain) << from_plain.error().describe();
  EXPECT_EQ(source->pieces.size(), from_plain->pieces.size());
  EXPECT_EQ(source->targets.size(), from_plain->targets.size());
  EXPECT_THAT(source->notes, testing::Contains(testing::HasSubstr("19 visemes")));
}

}  // namespace fdp_keyframes_test
}  // namespace animeme::test
