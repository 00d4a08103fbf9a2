// The meshes of the heads that are ready: closed, oriented, alike on both sides.
#include <algorithm>
#include <map>
#include <set>

#include "tests/head/head_support.h"

namespace animeme::test {
namespace mesh_test {

using head::Head;
using head::Mesh;
using head::Part;
using head::Triangle;
using head::Vec3;

class EachHead : public ::testing::TestWithParam<std::string> {
 protected:
  const Head& head() const { return head_of(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Heads, EachHead, ::testing::Values("woman", "man", "child"));

// How often each edge is used in each direction.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges_of(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  return edges;
}

// Closed: each edge belongs to two triangles that see it in opposite directions.
TEST_P(EachHead, AllPartsAreClosed) {
  for (std::size_t part = 0; part < head::kPartCount; ++part) {
    const Mesh& mesh = head().parts[part];
    ASSERT_FALSE(mesh.triangles.empty()) << head::kPartNames[part];
    ASSERT_EQ(mesh.colours.size(), mesh.positions.size()) << head::kPartNames[part];
    ASSERT_EQ(mesh.occlusion.size(), mesh.positions.size()) << head::kPartNames[part];
    const auto edges = edges_of(mesh);
    int open = 0;
    for (const auto& [edge, count] : edges) {
      const auto back = edges.find({edge.second, edge.first});
      open += back == edges.end() || back->second != count ? 1 : 0;
      EXPECT_TRUE(count == 1 || part != std::size_t(Part::skin));
    }
    EXPECT_EQ(open, 0) << head::kPartNames[part];
  }
}

// Lips have lines, the skin around them pores; what is wet or oily shines.
TEST_P(EachHead, SkinHasGrain) {
  const Mesh& skin = head().part(Part::skin);
  ASSERT_EQ(skin.grain.size(), skin.positions.size());
  const auto at = [&](const char* id) { return skin.grain[head().point(id).vertex]; };
  for (const char* lip : {"2.2", "2.3"}) EXPECT_LT(at(lip).relief, -0.9f) << lip;
  for (const char* bare : {"9.3", "5.3", "5.4", "11.1"}) EXPECT_GT(at(bare).relief, 0.3f) << bare;
  EXPECT_GT(at("9.3").gloss, 1.3f * at("5.3").gloss);
  EXPECT_GT(at("9.3").gloss, 1.3f * at("10.7").gloss);
  EXPECT_GT(at("2.3").gloss, 1.5f);
}

// Freckles are dark spots on nose and cheeks, and nowhere else.
TEST(Freckles, AreOnNoseAndCheeks) {
  head::HeadParameters parameters;
  const Head plain = *head::make_head(parameters);
  parameters.freckles = 1;
  const Head spotted = *head::make_head(parameters);
  const Mesh &before = plain.part(Part::skin), &after = spotted.part(Part::skin);
  ASSERT_EQ(before.positions, after.positions);
  int spots = 0, elsewhere = 0;
  for (std::size_t v = 0; v < before.positions.size(); ++v) {
    EXPECT_LE(after.colours[v].y, before.colours[v].y);
    if (after.colours[v].y > 0.9f * before.colours[v].y) continue;
    ++spots;
    elsewhere += std::abs(before.positions[v].y + 2.8f) > 5 || before.positions[v].z < 3 ? 1 : 0;
  }
  EXPECT_GT(spots, 60);
  EXPECT_EQ(elsewhere, 0);
}

// A closed mesh whose triangles look outwards has a positive volume.
TEST_P(EachHead, PartsLookOutwards) {
  for (std::size_t part = 0; part < head::kPartCount; ++part) {
    double volume = 0;
    const Mesh& mesh = head().parts[part];
    for (const Triangle& t : mesh.triangles) {
      volume += dot(mesh.positions[t[0]], cross(mesh.positions[t[1]], mesh.positions[t[2]])) / 6;
    }
    EXPECT_GT(volume, 0) << head::kPartNames[part];
  }
}

TEST_P(EachHead, SkinIsOneFaceAndTwoEars) {
  const Mesh& skin = head().part(Part::skin);
  std::vector<std::uint32_t> parent(skin.positions.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const auto root = [&parent](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : skin.triangles) {
    parent[root(t[0])] = root(t[1]);
    parent[root(t[1])] = root(t[2]);
  }
  std::set<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < parent.size(); ++i) roots.insert(root(i));
  EXPECT_EQ(roots.size(), 3u);
  // A closed surface without handles has V - E + F = 2.
  const auto edges = edges_of(skin).size() / 2;
  EXPECT_EQ(skin.positions.size() + skin.triangles.size() - edges, 6u);
}

TEST_P(EachHead, SizeIsAsPromised) {
  const std::size_t vertices = head().part(Part::skin).positions.size();
  EXPECT_GE(vertices, 15000u);
  EXPECT_LE(vertices, 30000u);
}

TEST_P(EachHead, NeutralSkinHasNoInvertedTriangles) {
  const auto& skin = rig_of(GetParam()).parts[0];
  EXPECT_LE(inverted_triangles(skin.positions, skin.normals, skin.triangles), 2);
}

TEST_P(EachHead, SkinIsAlikeOnBothSides) {
  const Mesh& skin = head().part(Part::skin);
  const auto key = [](Vec3 p, float sign) {
    return std::array<long, 3>{std::lround(sign * p.x * 1e4f), std::lround(p.y * 1e4f),
                               std::lround(p.z * 1e4f)};
  };
  std::multiset<std::array<long, 3>> left;
  std::multiset<std::array<long, 3>> right;
  for (const Vec3& p : skin.positions) {
    left.insert(key(p, 1));
    right.insert(key(p, -1));
  }
  EXPECT_EQ(left, right);
}

TEST_P(EachHead, HasAllFeaturePoints) {
  for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
    if (info.id == "7.1") continue;  // inside, no vertex
    const head::FeaturePoint point = head().point(info.id);
    ASSERT_TRUE(point.exists()) << info.id;
    ASSERT_LT(point.vertex, head().part(point.part).positions.size()) << info.id;
  }
  // Left and right points are mirror images.
  const std::pair<const char*, const char*> pairs[] = {
      {"2.4", "2.5"},   {"2.6", "2.7"},   {"2.8", "2.9"},   {"2.11", "2.12"}, {"2.13", "2.14"},
      {"3.1", "3.2"},   {"3.3", "3.4"},   {"3.5", "3.6"},   {"3.7", "3.12"},  {"3.9", "3.10"},
      {"3.11", "3.8"},  {"3.13", "3.14"}, {"4.1", "4.2"},   {"4.3", "4.4"},   {"4.5", "4.6"},
      {"5.1", "5.2"},   {"5.3", "5.4"},   {"8.3", "8.4"},   {"8.5", "8.6"},   {"8.7", "8.8"},
      {"8.10", "8.9"},  {"9.1", "9.2"},   {"9.5", "9.4"},   {"9.7", "9.6"},   {"9.13", "9.14"},
      {"10.1", "10.2"}, {"10.3", "10.4"}, {"10.5", "10.6"}, {"10.7", "10.8"}, {"10.9", "10.10"},
      {"11.3", "11.2"}};
  for (const auto& [left, right] : pairs) {
    const Vec3 l = head().at(left);
    const Vec3 r = head().at(right);
    EXPECT_GT(l.x, 0) << left;
    EXPECT_NEAR(l.x, -r.x, 1e-3) << left;
    EXPECT_NEAR(l.y, r.y, 1e-3) << left;
    EXPECT_NEAR(l.z, r.z, 1e-3) << left;
  }
}

// Where points are to each other, from their names.
TEST_P(EachHead, FeaturePointsAreWhereTheirNamesSay) {
  const auto at = [this](const char* id) { return head().at(id); };
  EXPECT_GT(at("11.4").y, at("11.1").y);
  EXPECT_GT(at("11.5").y, at("11.4").y - 0.5f);
  EXPECT_GT(at("11.1").y, at("4.3").y);
  EXPECT_GT(at("4.3").y, at("3.1").y);
  EXPECT_GE(at("4.3").y, at("4.1").y);
  EXPECT_GT(at("4.5").x, at("4.3").x);
  EXPECT_GT(at("4.3").x, at("4.1").x);
  EXPECT_GT(at("3.13").y, at("3.1").y);
  EXPECT_GT(at("3.1").y, at("3.3").y);
  EXPECT_GT(at("3.3").y, at("3.9").y);
  EXPECT_GT(at("3.7").x, at("3.5").x);
  EXPECT_GT(at("3.5").x, at("3.11").x);
  EXPECT_GT(at("9.3").z, at("9.12").z);
  EXPECT_GT(at("9.3").z, at("9.15").z);
  EXPECT_GT(at("9.15").y, at("8.1").y);
  EXPECT_GT(at("8.1").y, at("2.2").y);
  EXPECT_NEAR(at("2.2").y, at("2.3").y, 1e-4);
  EXPECT_GT(at("2.3").y, at("8.2").y);
  EXPECT_GT(at("8.2").y, at("2.10").y);
  EXPECT_GT(at("2.10").y, at("2.1").y);
  EXPECT_GT(at("8.3").x, at("2.4").x);
  EXPECT_GT(at("2.4").x, at("2.6").x);
  EXPECT_GT(at("10.1").y, at("10.5").y);
  EXPECT_LT(at("11.6").z, at("10.3").z);
  EXPECT_GT(at("9.8").y, at("9.10").y);
  EXPECT_GT(at("9.11").y, at("9.9").y);
  EXPECT_GT(at("6.1").z, at("6.2").z);
  EXPECT_GT(at("6.3").x, at("6.4").x);
}

// The neutral face of the standard: lids near the border of the iris, lips and teeth closed.
TEST_P(EachHead, IsNeutralAsTheStandardHasIt) {
  EXPECT_NEAR(head().fapu.irisd, 2 * head().eyes[0].iris_radius, 0.35 * head().fapu.irisd);
  EXPECT_NEAR(head().fapu.es, 2 * head().eyes[0].centre.x, 1e-3);
  for (const head::ContactPair& pair : head().seams.lips) {
    const auto& places = head().part(Part::skin).positions;
    EXPECT_LT(length(places[pair.upper] - places[pair.lower]), 1e-4f);
  }
  EXPECT_LT(std::abs(head().at("9.10").y - head().at("9.11").y), 0.2f);
}

TEST(MakeHead, IsTheSameEachTime) {
  const auto again = head::make_head(*head::head_parameters("woman"));
  ASSERT_TRUE(again);
  for (std::size_t part = 0; part < head::kPartCount; ++part) {
    EXPECT_EQ(again->parts[part].positions, head_of("woman").parts[part].positions);
    EXPECT_EQ(again->parts[part].triangles, head_of("woman").parts[part].triangles);
    EXPECT_EQ(again->parts[part].occlusion, head_of("woman").parts[part].occlusion);
  }
}

TEST(MakeHead, DensityChangesTheNumberOfVertices) {
  const auto coarse = head::make_head({.density = 0.5});
  ASSERT_TRUE(coarse);
  EXPECT_LT(coarse->part(Part::skin).positions.size(), 9000u);
  EXPECT_NEAR(coarse->fapu.mw, head_of("woman").fapu.mw, 0.3);
  const auto edges = edges_of(coarse->part(Part::skin));
  for (const auto& [edge, count] : edges) EXPECT_TRUE(edges.contains({edge.second, edge.first}));
}

TEST(MakeHead, RefusesSizesThatAreNone) {
  for (const double bad : {0.0, -1.0, 1e9, std::nan("")}) {
    const auto head = head::make_head({.jaw_width = bad});
    ASSERT_FALSE(head);
    EXPECT_EQ(head.error().code, Code::invalid_argument);
    EXPECT_NE(head.error().message.find("jaw_width"), std::string::npos);
  }
  EXPECT_FALSE(head::make_head({.density = 3}));
  EXPECT_FALSE(head::head_parameters("dragon"));
}

}  // namespace mesh_test
}  // namespace animeme::test
