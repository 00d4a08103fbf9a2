// Teeth and gums stay behind the skin while the lips are shut.
#include "fap/tables.h"
#include "tests/head/head_support.h"

namespace animeme::test {
namespace cover_test {

using head::Part;
using head::Vec3;

// Triangles seen along a direction, in a grid of what they cover.
class Cover {
 public:
  Cover(const std::vector<Vec3>& places, const std::vector<head::Triangle>& triangles, Vec3 to_eye)
      : to_eye_(to_eye), cells_(kCells * kCells) {
    for (const head::Triangle& t : triangles) {
      const Flat a = flat(places[t[0]]), b = flat(places[t[1]]), c = flat(places[t[2]]);
      const auto [left, right] = std::minmax({cell(a.x), cell(b.x), cell(c.x)});
      const auto [bottom, top] = std::minmax({cell(a.y), cell(b.y), cell(c.y)});
      for (int y = bottom; y <= top; ++y) {
        for (int x = left; x <= right; ++x)
          cells_[std::size_t(y * kCells + x)].push_back({a, b, c});
      }
    }
  }

  // Whether skin is before a place, or behind it by no more than is seen.
  bool hides(Vec3 place) const {
    constexpr float kNotSeen = 0.01f;  // cm
    const Flat p = flat(place);
    for (const auto& [a, b, c] : cells_[std::size_t(cell(p.y) * kCells + cell(p.x))]) {
      const float area = cross(b - a, c - a);
      const float u = cross(c - b, p - b) / area, v = cross(a - c, p - c) / area;
      if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
      if (a.depth * u + b.depth * v + c.depth * (1 - u - v) > p.depth - kNotSeen) return true;
    }
    return false;
  }

 private:
  struct Flat {
    float x, y, depth;
    friend Flat operator-(Flat a, Flat b) { return {a.x - b.x, a.y - b.y, 0}; }
  };
  static float cross(Flat a, Flat b) { return a.x * b.y - a.y * b.x; }
  Flat flat(Vec3 p) const {
    return {p.x * to_eye_.z - p.z * to_eye_.x, p.y, p.x * to_eye_.x + p.z * to_eye_.z};
  }
  static constexpr int kCells = 128;
  static int cell(float at) { return std::clamp(int((at + 14) / 28 * kCells), 0, kCells - 1); }

  Vec3 to_eye_;
  std::vector<std::vector<std::array<Flat, 3>>> cells_;
};

class CoveredFace : public ::testing::TestWithParam<std::string> {
 protected:
  const head::Rig& rig() const { return rig_of(GetParam()); }

  // Vertices of teeth and gums that are seen from the front or from a side.
  int seen(const fap::Frame& frame) {
    head::pose(rig(), frame, pose_);
    int count = 0;
    for (const Vec3 to_eye : {Vec3{0, 0, 1}, Vec3{0.64f, 0, 0.77f}}) {
      const Cover cover(pose_.positions[0], rig().parts[0].triangles, to_eye);
      for (const Part part : {Part::upper_teeth, Part::lower_teeth}) {
        for (const Vec3& p : rig().parts[std::size_t(part)].positions) {
          count += cover.hides(pose_.transforms[std::size_t(part)](p)) ? 0 : 1;
        }
      }
    }
    return count;
  }

  head::Pose pose_;
};
INSTANTIATE_TEST_SUITE_P(Heads, CoveredFace, ::testing::Values("woman", "man", "child"));

// What moves jaw, chin, lips and cheeks and does not part the lips, as far as intra planes code it
// by default: alone, and each two together.
TEST_P(CoveredFace, HidesItsTeethBehindShutLips) {
  const std::vector<std::vector<int>> moves = {
      {3}, {14}, {15}, {16}, {17}, {18}, {6, 7, 53, 54}, {12, 13, 59, 60}, {39, 40}};
  EXPECT_EQ(seen({}), 0);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      for (const int share : {-30, -3, -1, 1, 3, 30}) {
        fap::Frame frame;
        for (const std::size_t m : {k, i}) {
          for (const int fap : moves[m]) {
            const fap::FapInfo& info = fap::info(fap);
            frame.set(fap, info.quant_step * info.default_i_range / share);
          }
        }
        EXPECT_EQ(seen(frame), 0) << moves[k][0] << " and " << moves[i][0] << ": "
                                  << frame.value[std::size_t(moves[k][0])] << ", "
                                  << frame.value[std::size_t(moves[i][0])];
      }
    }
  }
}

}  // namespace cover_test
}  // namespace animeme::test
