// Teeth and gums stay behind the skin, whatever the FAPs say.
#include "fap/head/shapes.h"
#include "tests/head/outside.h"

namespace animeme::test {
namespace teeth_test {

using head::Part;
using head::Triangle;
using head::Vec3;

// The skin seen from one direction: which of its triangles lie at a place of the picture.
class View {
 public:
  View(Vec3 towards, const std::vector<Vec3>& skin, const std::vector<Triangle>& triangles)
      : towards_(towards),
        aside_(cross(Vec3{0, 1, 0}, towards)),
        skin_(skin),
        cells_(kCells * kCells) {
    for (const Triangle& t : triangles) {
      const Vec3 a = seen(skin[t[0]]), b = seen(skin[t[1]]), c = seen(skin[t[2]]);
      if ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) <= 0) continue;  // its back
      const auto [left, right] = std::minmax({a.x, b.x, c.x});
      const auto [low, high] = std::minmax({a.y, b.y, c.y});
      for (int x = cell(left); x <= cell(right); ++x) {
        for (int y = cell(low); y <= cell(high); ++y) cells_[index(x, y)].push_back(t);
      }
    }
  }

  // How far a place stands out of the skin behind it: nothing if there is skin before it as well,
  // or none near behind it, as in an open mouth.
  float before_skin(Vec3 place) const {
    constexpr float kNear = 1;  // further behind is the far corner of an open mouth
    const Vec3 p = seen(place);
    float nearest = kNear;
    for (const Triangle& t : cells_[index(cell(p.x), cell(p.y))]) {
      const Vec3 a = seen(skin_[t[0]]), b = seen(skin_[t[1]]), c = seen(skin_[t[2]]);
      const float of_a = area(p, b, c), of_b = area(a, p, c), of_c = area(a, b, p);
      if (of_a < 0 || of_b < 0 || of_c < 0) continue;
      const float depth = (a.z * of_a + b.z * of_b + c.z * of_c) / (of_a + of_b + of_c);
      if (depth >= p.z) return 0;
      nearest = std::min(nearest, p.z - depth);
    }
    return nearest < kNear ? nearest : 0;
  }

 private:
  // Places that are farther from each other than any two of a face may share a cell.
  static constexpr unsigned kCells = 128;
  static std::size_t index(int x, int y) {
    return std::size_t(unsigned(x) % kCells * kCells + unsigned(y) % kCells);
  }
  static int cell(float along) { return int(std::floor(along / 0.2f)); }
  static float area(Vec3 a, Vec3 b, Vec3 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  Vec3 seen(Vec3 p) const { return {dot(p, aside_), p.y, dot(p, towards_)}; }

  Vec3 towards_, aside_;
  const std::vector<Vec3>& skin_;
  std::vector<std::vector<Triangle>> cells_;
};

class EachBite : public ::testing::TestWithParam<std::string> {
 protected:
  const head::Rig& rig() const { return rig_of(GetParam()); }

  // The triangles of the skin around the teeth.
  static std::vector<Triangle> around_teeth(const head::Head& head, const head::Rig& rig) {
    std::vector<Triangle> near;
    const float size = float(rig.fapu.es) / 6.3f;
    const auto& skin = rig.parts[std::size_t(Part::skin)].positions;
    for (const Triangle& t : outside_of(head, true)) {
      const Vec3 d = skin[t[0]] - rig.teeth[0].middle;
      if (d.z > -1 * size && std::abs(d.x) < 5 * size && std::abs(d.y) < 5 * size)
        near.push_back(t);
    }
    return near;
  }

  // How far teeth and gums stand out of the skin, cm.
  float out_of_skin(fap::Frame frame) {
    for (const std::size_t f : {48u, 49u, 50u}) frame.mask.reset(f);
    head::pose(rig(), frame, pose_);
    float most = 0;
    for (const float aside : {0.0f, -0.7f, 0.7f}) {
      const View view(normalised(Vec3{aside, 0, 0.7f}), pose_.positions[0], near_);
      for (const Part part : {Part::upper_teeth, Part::lower_teeth}) {
        const auto i = std::size_t(part);
        for (const Vec3& p : rig().parts[i].positions) {
          most = std::max(most, view.before_skin(pose_.transforms[i](p)));
        }
      }
    }
    ++shown_;
    return most;
  }

  const std::vector<Triangle> near_ = around_teeth(head_of(GetParam()), rig());
  head::Pose pose_;
  int shown_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Heads, EachBite, ::testing::Values("woman", "man", "child"));

int most_of(int fap) { return fap::info(fap).quant_step * fap::info(fap).default_i_range; }

TEST_P(EachBite, TeethStayBehindTheSkin) {
  for (int fap = fap::kFirstLowLevel; fap <= 64; ++fap) {
    if (fap > 18 && fap < 39) continue;  // eyes and brows
    const int mirror = fap::info(fap).mirror;
    for (const double share : {-1.0, -0.3, 0.3, 1.0}) {
      fap::Frame frame;
      frame.set(fap, int(share * most_of(fap)));
      EXPECT_LT(out_of_skin(frame), 0.01f) << fap << " at " << share;
      if (mirror == 0) continue;
      frame.set(mirror, int(share * most_of(fap)));
      EXPECT_LT(out_of_skin(frame), 0.01f) << fap << " with " << mirror << " at " << share;
    }
  }
}

// FAPs that people move together, each as far as it goes.
TEST_P(EachBite, TeethStayBehindTheSkinInPairs) {
  const std::vector<int> sets[][2] = {{{4}, {5}},
                                      {{4, 8, 9}, {5, 10, 11}},
                                      {{14}, {3}},
                                      {{14}, {15}},
                                      {{14}, {16}},
                                      {{14}, {17}},
                                      {{14}, {18}},
                                      {{14}, {4, 8, 9}},
                                      {{14}, {5, 10, 11}},
                                      {{16}, {17}},
                                      {{16}, {3}},
                                      {{17}, {3}},
                                      {{15}, {3}},
                                      {{16}, {5, 10, 11}},
                                      {{17}, {4, 8, 9}},
                                      {{12, 13}, {6, 7}},
                                      {{12, 13}, {3}},
                                      {{6, 7}, {3}},
                                      {{18}, {3}},
                                      {{18}, {16}},
                                      {{51, 55, 56}, {52, 57, 58}},
                                      {{53, 54}, {6, 7}},
                                      {{59, 60}, {12, 13}},
                                      {{39, 40}, {6, 7}}};
  for (const auto& [some, others] : sets) {
    for (const double a : {-1.0, -0.3, 0.3, 1.0}) {
      for (const double b : {-1.0, -0.3, 0.3, 1.0}) {
        fap::Frame frame;
        for (const int fap : some) frame.set(fap, int(a * most_of(fap)));
        for (const int fap : others) frame.set(fap, int(b * most_of(fap)));
        EXPECT_LT(out_of_skin(frame), 0.01f)
            << some[0] << " at " << a << " with " << others[0] << " at " << b;
      }
    }
  }
}

TEST_P(EachBite, TeethStayBehindTheSkinInVisemesAndExpressions) {
  for (int viseme = 0; viseme <= 14; ++viseme) {
    EXPECT_LT(out_of_skin(head::viseme_shape(viseme)), 0.01f) << "viseme " << viseme;
  }
  for (int expression = 1; expression <= 6; ++expression) {
    EXPECT_LT(out_of_skin(head::expression_shape(expression)), 0.01f)
        << "expression " << expression;
  }
}

}  // namespace teeth_test
}  // namespace animeme::test
