#include "tools/gltf/detail/slit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace animeme::gltf {
namespace {

using head::Vec3;

constexpr float kParts = 0.09f;  // of the jaw's motion: what parts by more are the two lips
constexpr float kNear = 0.03f;   // of the distance of the eyes

// The pair of the smallest cost.
template <class Cost>
Slit::Pair best(const std::vector<Slit::Pair>& pairs, Cost cost) {
  Slit::Pair found;
  float least = std::numeric_limits<float>::infinity();
  for (const Slit::Pair& pair : pairs) {
    const float value = cost(pair);
    if (!(value < least)) continue;
    least = value;
    found = pair;
  }
  return found;
}

}  // namespace

Slit::Slit(const SkinShapes& face, const std::vector<std::vector<Vec3>>& jaw, float most, Vec3 lip,
           float between)
    : face_(face), between_(between) {
  const auto down = [&](Spot spot) { return -jaw[spot.piece][spot.vertex].y; };
  const std::vector<Spot> spots = around(lip);
  const float near = kNear * between;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const Vec3 p = face.place(spots[i]);
    Pair pair{{}, {}, near};
    const auto look_at = [&](Spot other) {
      const float apart = length(face.place(other) - p);
      if (apart < pair.apart && down(other) - down(spots[i]) > kParts * most) {
        pair = {spots[i], other, apart};
      }
    };
    for (std::size_t k = i; k-- > 0 && face.place(spots[k]).y - p.y < near;) look_at(spots[k]);
    for (std::size_t k = i + 1; k < spots.size() && p.y - face.place(spots[k]).y < near; ++k) {
      look_at(spots[k]);
    }
    if (pair.exists()) pairs_.push_back(pair);
  }
}

// Skin around the mouth, from above.
std::vector<Spot> Slit::around(Vec3 lip) const {
  std::vector<Spot> spots;
  face_.for_skin([&](Spot spot) {
    const Vec3 d = face_.place(spot) - lip;
    if (std::abs(d.x) < 0.7f * between_ && std::abs(d.y) < 0.25f * between_ &&
        d.z > -0.45f * between_) {
      spots.push_back(spot);
    }
  });
  std::stable_sort(spots.begin(), spots.end(),
                   [&](Spot a, Spot b) { return face_.place(a).y > face_.place(b).y; });
  return spots;
}

Slit::Pair Slit::end(float sign) const {
  return best(pairs_, [&](const Pair& pair) { return -sign * face_.place(pair.upper).x; });
}

Slit::Pair Slit::nearest(Vec3 place) const {
  return best(pairs_, [&](const Pair& pair) { return length(face_.place(pair.upper) - place); });
}

// Behind the lips there may be others as close to each other: the inside of the mouth.
Slit::Pair Slit::contact(float x) const {
  return best(pairs_, [&](const Pair& pair) {
    const Vec3 p = face_.place(pair.upper);
    return pair.apart + 0.5f * std::abs(p.x - x) - 0.3f * p.z;
  });
}

}  // namespace animeme::gltf
