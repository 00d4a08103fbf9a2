#include "fap/head/detail/sided_bodies.h"

#include <map>
#include <tuple>

namespace animeme::head::detail {
namespace {

// Union-find that knows of each triangle whether it agrees with its root, the first of them.
class Agreement {
 public:
  explicit Agreement(std::size_t count) : parent_(count), differs_(count) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = i;
  }
  std::pair<std::size_t, bool> root(std::size_t i) {
    bool differs = false;
    std::size_t top = i;
    for (; parent_[top] != top; top = parent_[top]) differs = differs != bool(differs_[top]);
    for (bool left = differs; i != top && parent_[i] != top;) {  // shorten the way
      const std::size_t next = parent_[i];
      const bool step = bool(differs_[i]);
      parent_[i] = top;
      differs_[i] = left;
      left = left != step;
      i = next;
    }
    return {top, differs};
  }
  void join(std::size_t a, std::size_t b, bool differ) {
    const auto [root_a, differs_a] = root(a);
    const auto [root_b, differs_b] = root(b);
    if (root_a == root_b) return;
    const auto [low, high] = std::minmax(root_a, root_b);
    parent_[high] = low;
    differs_[high] = (differs_a != differs_b) != differ;
  }

 private:
  std::vector<std::size_t> parent_;
  std::vector<std::uint8_t> differs_;
};

// For each vertex the first one in its place.
std::vector<std::uint32_t> places_of(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.positions.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
  const auto key = [&](std::uint32_t v) {
    const Vec3 p = mesh.positions[v];
    return std::tuple(p.x, p.y, p.z);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    place[order[i]] = same ? place[order[i - 1]] : order[i];
  }
  return place;
}

std::vector<bool> one_sided(const Mesh& mesh, const std::vector<std::uint32_t>& place) {
  std::vector<std::pair<Triangle, std::size_t>> sorted;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle key = mesh.triangles[t];
    for (std::uint32_t& v : key) v = place[v];
    std::sort(key.begin(), key.end());
    sorted.push_back({key, t});
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> single(mesh.triangles.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto& key = sorted[i].first;
    single[sorted[i].second] = key[0] != key[1] && key[1] != key[2] &&
                               (i == 0 || sorted[i - 1].first != key) &&
                               (i + 1 == sorted.size() || sorted[i + 1].first != key);
  }
  return single;
}

struct Edge {
  std::uint32_t low, high, triangle;
  bool upwards;  // from low to high
};

Edge edge_of(std::uint32_t a, std::uint32_t b, std::uint32_t triangle) {
  return {std::min(a, b), std::max(a, b), triangle, a < b};
}

// Joins the triangles of edges that are there twice; what is there once comes back.
std::vector<Edge> join_pairs(std::vector<Edge> edges, Agreement& agreement) {
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::vector<Edge> open;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    const auto same = [&](const Edge& e) {
      return e.low == edges[i].low && e.high == edges[i].high;
    };
    for (end = i + 1; end < edges.size() && same(edges[end]);) ++end;
    if (end - i == 1) open.push_back(edges[i]);
    if (end - i == 2) {
      agreement.join(edges[i].triangle, edges[i + 1].triangle,
                     edges[i].upwards == edges[i + 1].upwards);
    }
  }
  return open;
}

}  // namespace

std::vector<SidedTriangle> sided_bodies(const Mesh& mesh) {
  const std::vector<std::uint32_t> place = places_of(mesh);
  const std::vector<bool> single = one_sided(mesh, place);
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    for (std::size_t k = 0; single[t] && k < 3; ++k) {
      edges.push_back(edge_of(corners[k], corners[(k + 1) % 3], t));
    }
  }
  Agreement agreement(mesh.triangles.size());
  edges = join_pairs(std::move(edges), agreement);
  for (Edge& e : edges) {
    const std::uint32_t from = place[e.upwards ? e.low : e.high];
    const std::uint32_t to = place[e.upwards ? e.high : e.low];
    e = edge_of(from, to, e.triangle);
  }
  join_pairs(std::move(edges), agreement);
  std::vector<SidedTriangle> out(mesh.triangles.size());
  std::map<std::size_t, std::uint32_t> body_of;  // by root
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    if (!single[t]) continue;
    const auto [root, differs] = agreement.root(t);
    out[t] = {body_of.try_emplace(root, std::uint32_t(body_of.size())).first->second, differs};
  }
  return out;
}

}  // namespace animeme::head::detail
