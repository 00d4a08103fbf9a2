// Cheeks that rise in smiles.
#include "fap/head/shapes.h"
#include "tests/head/head_support.h"

namespace animeme::test {
namespace smile_test {

using head::Pose;
using head::Vec3;

class EachSmile : public ::testing::TestWithParam<std::string> {
 protected:
  const head::Head& head() const { return head_of(GetParam()); }
  const head::Rig& rig() const { return rig_of(GetParam()); }
  const std::vector<Vec3>& rest() const { return rig().parts[0].positions; }

  Pose shown(std::initializer_list<std::pair<int, int>> faps) const {
    fap::Frame frame;
    for (const auto& [fap, value] : faps) {
      frame.set(fap, value);
      if (const int mirror = fap::info(fap).mirror) frame.set(mirror, value);
    }
    return head::pose(rig(), frame);
  }

  // The vertex beside the middle of the way from nose to corner of the mouth, outwards by a share
  // of that.
  std::size_t beside(bool left, float outwards) const {
    const Vec3 wing = head().at(left ? "9.1" : "9.2");
    const Vec3 way = head().at(left ? "2.4" : "2.5") - wing;
    const Vec3 out = left ? Vec3{-way.y, way.x, 0} : Vec3{way.y, -way.x, 0};
    const Vec3 place = wing + way * 0.55f + out * outwards;
    std::size_t best = 0;
    float least = 1e9f;
    for (std::size_t v = 0; v < rest().size(); ++v) {
      const Vec3 d{rest()[v].x - place.x, rest()[v].y - place.y, 0};
      if (rest()[v].z < wing.z - length(way) || dot(d, d) >= least) continue;
      best = v;
      least = dot(d, d);
    }
    return best;
  }

  // How much deeper than at rest the nasolabial fold lies between lip and cheek, in MNS.
  float fold(const Pose& pose, bool left) const {
    const std::size_t lip = beside(left, 0.02f), line = beside(left, 0.18f);
    const std::size_t cheek = beside(left, 0.52f);
    const auto depth = [&](const std::vector<Vec3>& skin) {
      return (mix(skin[lip], skin[cheek], 0.32f) - skin[line]).z;
    };
    return (depth(pose.positions[0]) - depth(rest())) / float(rig().fapu.mns);
  }
};
INSTANTIATE_TEST_SUITE_P(Heads, EachSmile, ::testing::Values("woman", "man", "child"));

TEST_P(EachSmile, RaisesTheCheekBesideAFold) {
  for (const bool left : {true, false}) {
    EXPECT_GT(fold(head::pose(rig(), head::expression_shape(1)), left), 0.05f);
    EXPECT_GT(fold(shown({{12, 300}, {59, 300}, {6, 150}, {53, 150}, {41, 150}}), left), 0.06f);
    EXPECT_GT(fold(shown({{41, 150}}), left), 0.01f);
    // More of it than of one.
    EXPECT_GT(fold(shown({{12, 300}, {41, 150}}), left), fold(shown({{12, 300}}), left));
    EXPECT_LT(std::abs(fold(shown({{12, -300}, {59, -300}}), left)), 0.04f);
    EXPECT_EQ(fold(shown({{3, 0}}), left), 0);
  }
}

}  // namespace smile_test
}  // namespace animeme::test
