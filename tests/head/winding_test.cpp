// Meshes that are wound the other way are turned, and none that was right.
#include <gmock/gmock.h>

#include <numbers>

#include "fap/head/detail/own_steps.h"
#include "fap/head/own_head.h"
#include "tests/head/head_support.h"

namespace animeme::test {
namespace winding_test {

using head::Head;
using head::Part;
using head::Piece;
using head::Source;
using head::Triangle;
using head::Vec3;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kNote = "inside-out triangles";

// A head of few vertices, which is looked at quickly.
const Head& small() {
  static const Head head = [] {
    head::HeadParameters parameters = *head::head_parameters("child");
    parameters.density = 0.5;
    return *head::make_head(parameters);
  }();
  return head;
}

// One of our heads as if somebody else had made it: a piece for each part.
Source source_of(const Head& head) {
  Source source;
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    source.pieces.push_back({std::string(head::kPartNames[p]), "", head.parts[p], {}});
  }
  for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
    const head::FeaturePoint point = head.feature_points[i];
    if (!point.exists()) continue;
    source.points.push_back(
        {std::string(fap::kFeaturePoints[i].id), std::size_t(point.part), point.vertex});
  }
  source.upright = true;
  return source;
}

void flip(Piece& piece) {
  for (Triangle& t : piece.mesh.triangles) std::swap(t[1], t[2]);
}

Head assembled(Source source, std::vector<std::string>* notes = nullptr) {
  auto head = head::assemble(std::move(source), notes);
  EXPECT_TRUE(head) << head.error().describe();
  return head ? std::move(*head) : Head{};
}

// Triangles that look the other way than those of `wanted`.
std::size_t inside_out(const head::Mesh& is, const std::vector<Triangle>& wanted) {
  EXPECT_EQ(is.triangles.size(), wanted.size());
  std::size_t count = 0;
  for (std::size_t t = 0; t < wanted.size(); ++t) {
    const Triangle& a = is.triangles[t];
    const Triangle& b = wanted[t];
    count += a == b || a == Triangle{b[1], b[2], b[0]} || a == Triangle{b[2], b[0], b[1]} ? 0 : 1;
  }
  return count;
}

std::size_t inside_out(const Head& is, const Head& wanted) {
  std::size_t count = 0;
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    count += inside_out(is.parts[p], wanted.parts[p].triangles);
  }
  return count;
}

class Winding : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Heads, Winding, ::testing::Values("woman", "man", "child"));

TEST_P(Winding, WhatIsRightStays) {
  std::vector<std::string> notes;
  EXPECT_EQ(inside_out(assembled(source_of(head_of(GetParam())), &notes), head_of(GetParam())), 0u);
  EXPECT_THAT(notes, Each(Not(HasSubstr(kNote))));
}

TEST_P(Winding, WholeHeadsAreTurned) {
  Source source = source_of(head_of(GetParam()));
  for (Piece& piece : source.pieces) flip(piece);
  std::vector<std::string> notes;
  EXPECT_EQ(inside_out(assembled(source, &notes), head_of(GetParam())), 0u);
  EXPECT_THAT(notes, Contains("mesh \"skin\": flipped all " +
                              std::to_string(source.pieces[0].mesh.triangles.size()) +
                              " inside-out triangles"));
}

// The points do not have to be known: the eyes are enough.
TEST(WindingOfParts, HeadsWithoutPoints) {
  Source source = source_of(small());
  for (Piece& piece : source.pieces) flip(piece);
  source.points.clear();
  source.fapu = small().fapu;
  EXPECT_EQ(inside_out(assembled(source), small()), 0u);
}

TEST(WindingOfParts, EachIsTurnedForItself) {
  head::detail::PieceOfTriangle pieces;
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    pieces[p].assign(small().parts[p].triangles.size(), std::uint32_t(p));
  }
  for (std::size_t part = 0; part < head::kPartCount; ++part) {
    Head head = small();
    for (Triangle& t : head.parts[part].triangles) std::swap(t[1], t[2]);
    const auto turned = head::detail::turn_inside_out(head, float(head.fapu.es), pieces);
    if (head::Part(part) == head::Part::brows || head::Part(part) == head::Part::lashes) {
      // Hairs that are thinner than what rays find are left as they are.
      EXPECT_TRUE(turned.empty());
      continue;
    }
    EXPECT_EQ(inside_out(head, small()), 0u) << head::kPartNames[part];
    ASSERT_EQ(turned.size(), 1u) << head::kPartNames[part];
    EXPECT_EQ(turned[0].piece, part);
    EXPECT_EQ(turned[0].turned, head.parts[part].triangles.size());
    EXPECT_EQ(turned[0].triangles, turned[0].turned);
  }
}

// Neighbours that contradict each other: a patch of the face, and every other lock of hair.
TEST(WindingOfParts, SomeTrianglesAreTurned) {
  Source source = source_of(small());
  std::size_t flipped = 0;
  head::Mesh& skin = source.pieces[0].mesh;
  for (Triangle& t : skin.triangles) {
    const Vec3 p = skin.positions[t[0]];
    if (length(p - small().at("5.3")) > 1.5f) continue;
    std::swap(t[1], t[2]);
    ++flipped;
  }
  ASSERT_GT(flipped, 20u);
  std::vector<std::string> notes;
  EXPECT_EQ(inside_out(assembled(source, &notes), small()), 0u);
  EXPECT_THAT(notes, Contains("mesh \"skin\": flipped " + std::to_string(flipped) +
                              " inside-out triangles"));
}

// A mask is seen from behind as well.
TEST(WindingOfSheets, Masks) {
  Source source = source_of(small());
  head::Mesh& skin = source.pieces[0].mesh;
  const float ear = small().at("2.1").z - 4;
  std::erase_if(skin.triangles, [&](const Triangle& t) { return skin.positions[t[0]].z < ear; });
  source.pieces.erase(source.pieces.begin() + int(Part::hair), source.pieces.end());
  std::erase_if(source.points, [&](const auto& p) { return p.piece >= source.pieces.size(); });
  const std::vector<Triangle> right = skin.triangles;
  for (const bool points_known : {true, false}) {
    Source mask = source;
    if (!points_known) {
      mask.points.clear();
      mask.fapu = small().fapu;
    }
    EXPECT_EQ(inside_out(assembled(mask).part(Part::skin), right), 0u);
    flip(mask.pieces[0]);
    EXPECT_EQ(inside_out(assembled(mask).part(Part::skin), right), 0u);
  }
}

// A bag behind the lips, a mesh of its own, rightly shows its inside to those who look in.
TEST(WindingOfSheets, HollowsStay) {
  Source source = source_of(small());
  Piece bag{"head_mouth_bag", "", {}, {}};
  const Vec3 middle = small().at("2.2") - Vec3{0, 0, 4};
  constexpr std::uint32_t kRound = 12;
  for (std::uint32_t row = 0; row < 6; ++row) {
    for (std::uint32_t i = 0; i < kRound; ++i) {
      const float a = float(i) * 2 * float(std::numbers::pi) / kRound;
      const float b = float(row + 1) * float(std::numbers::pi) / 8;  // from the back, open before
      bag.mesh.positions.push_back(
          middle + Vec3{std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), -std::cos(b)} * 1.5f);
      if (row == 0) continue;
      const std::uint32_t v = row * kRound + i;
      const std::uint32_t w = row * kRound + (i + 1) % kRound;
      bag.mesh.triangles.push_back({v, v - kRound, w});
      bag.mesh.triangles.push_back({w, v - kRound, w - kRound});
    }
  }
  for (const bool other_way : {false, true}) {
    Piece one = bag;
    if (other_way) flip(one);
    Source with = source;
    with.pieces.push_back(one);
    const Head head = assembled(with);
    std::vector<Triangle> wanted = small().part(Part::skin).triangles;
    const auto first = std::uint32_t(small().part(Part::skin).positions.size());
    for (const Triangle& t : one.mesh.triangles) {
      wanted.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    EXPECT_EQ(inside_out(head.part(Part::skin), wanted), 0u);  // it cannot be seen: it stays
    // Where all else is wrong, so is the bag.
    for (Piece& piece : with.pieces) flip(piece);
    EXPECT_EQ(inside_out(assembled(with).part(Part::skin), wanted), 0u);
  }
}

// Cards of hair: sheets around the head that look outwards; with two sides they have no back.
TEST(WindingOfSheets, CardsOfHair) {
  Source source = source_of(small());
  head::Mesh cards;
  for (int i = 0; i < 40; ++i) {
    const float a = float(i) * 2 * float(std::numbers::pi) / 40;
    const auto corner = [&](float da, float y) {
      return Vec3{9 * std::sin(a + da), y, 9 * std::cos(a + da) - 1};
    };
    const auto v = std::uint32_t(cards.positions.size());
    for (const Vec3& p : {corner(-0.06f, 0), corner(0.06f, 0), corner(0.06f, 6), corner(-0.06f, 6)})
      cards.positions.push_back(p);
    cards.triangles.push_back({v, v + 1, v + 2});
    cards.triangles.push_back({v, v + 2, v + 3});
  }
  source.pieces[std::size_t(Part::hair)].mesh = cards;
  std::erase_if(source.points, [](const auto& p) { return p.piece == std::size_t(Part::hair); });
  std::vector<std::string> notes;
  EXPECT_EQ(inside_out(assembled(source, &notes).part(Part::hair), cards.triangles), 0u);
  EXPECT_THAT(notes, Each(Not(HasSubstr(kNote))));
  Source wrong = source;
  flip(wrong.pieces[std::size_t(Part::hair)]);
  EXPECT_EQ(inside_out(assembled(wrong).part(Part::hair), cards.triangles), 0u);
  Source both = source;
  for (const Triangle& t : cards.triangles) {
    both.pieces[std::size_t(Part::hair)].mesh.triangles.push_back({t[0], t[2], t[1]});
  }
  const std::vector<Triangle> as_given = both.pieces[std::size_t(Part::hair)].mesh.triangles;
  EXPECT_EQ(assembled(both).part(Part::hair).triangles, as_given);
}

}  // namespace winding_test
}  // namespace animeme::test
