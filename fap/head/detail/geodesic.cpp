#include "fap/head/detail/geodesic.h"

#include <limits>
#include <queue>

namespace animeme::head::detail {

Neighbours neighbours_of(std::size_t vertices, std::span<const Triangle> triangles) {
  std::vector<std::vector<std::uint32_t>> lists(vertices);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      lists[t[k]].push_back(t[(k + 1) % 3]);
      lists[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  Neighbours result;
  result.first.push_back(0);
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    result.ids.insert(result.ids.end(), list.begin(), list.end());
    result.first.push_back(std::uint32_t(result.ids.size()));
  }
  return result;
}

std::vector<Reached> walk(std::span<const Vec3> positions, const Neighbours& neighbours,
                          std::span<const std::uint32_t> starts, float reach) {
  std::vector<float> best(positions.size(), std::numeric_limits<float>::max());
  const auto later = [](const Reached& a, const Reached& b) {
    return a.distance != b.distance ? a.distance > b.distance : a.vertex > b.vertex;
  };
  std::priority_queue<Reached, std::vector<Reached>, decltype(later)> open(later);
  std::vector<Reached> result;
  for (const std::uint32_t start : starts) {
    best[start] = 0;
    open.push({start, 0});
  }
  while (!open.empty()) {
    const Reached at = open.top();
    open.pop();
    if (at.distance > best[at.vertex]) continue;
    result.push_back(at);
    for (const std::uint32_t next : neighbours.of(at.vertex)) {
      const float d = at.distance + length(positions[next] - positions[at.vertex]);
      if (d > reach || d >= best[next]) continue;
      best[next] = d;
      open.push({next, d});
    }
  }
  return result;
}

}  // namespace animeme::head::detail
