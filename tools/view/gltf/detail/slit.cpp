#include "tools/view/gltf/detail/slit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace animeme::gltf {
namespace {

using head::Vec3;

constexpr float kParts = 0.09f;  // of the jaw's motion: what parts by more are the two lips
constexpr float kNear = 0.03f;   // of the distance of the eyes
// What parts by less than this share of what parts there is skin that stretches.
constexpr float kNearlyAll = 0.5f;

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
    const auto each_near = [&](auto look_at) {
      for (std::size_t k = i; k-- > 0 && face.place(spots[k]).y - p.y < near;) look_at(spots[k]);
      for (std::size_t k = i + 1; k < spots.size() && p.y - face.place(spots[k]).y < near; ++k) {
        look_at(spots[k]);
      }
    };
    const auto apart = [&](Spot other) { return length(face.place(other) - p); };
    const auto parts = [&](Spot other) { return down(other) - down(spots[i]); };
    float most_parts = 0;
    each_near([&](Spot other) {
      if (apart(other) < near) most_parts = std::max(most_parts, parts(other));
    });
    // The nearest of those that part, not the other side of a lip that thins.
    const float enough = std::max(kParts * most, kNearlyAll * most_parts);
    Pair pair{{}, {}, near};
    each_near([&](Spot other) {
      if (apart(other) < pair.apart && parts(other) > enough) {
        pair = {spots[i], other, apart(other), parts(other)};
      }
    });
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

// Between lip and nose skin stretches where the upper lip rises, as that of drawn faces does.
bool Slit::is_lips(const Pair& pair) const {
  const auto x = [&](const Pair& of) { return face_.place(of.upper).x; };
  return std::ranges::none_of(pairs_, [&](const Pair& other) {
    return std::abs(x(other) - x(pair)) < kNear * between_ && kNearlyAll * other.parts > pair.parts;
  });
}

// Behind the lips there may be others as close to each other: the inside of the mouth.
Slit::Pair Slit::contact(float x) const {
  return best(pairs_, [&](const Pair& pair) {
    const Vec3 p = face_.place(pair.upper);
    const float cost = pair.apart + 0.5f * std::abs(p.x - x) - 0.3f * p.z;
    return is_lips(pair) ? cost : std::numeric_limits<float>::infinity();
  });
}

}  // namespace animeme::gltf
