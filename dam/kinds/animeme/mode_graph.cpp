#include "dam/kinds/animeme/mode_graph.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

namespace animeme::dam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Layers {
  std::vector<std::size_t> first;          // number of the first node of each layer
  std::vector<std::vector<double>> edges;  // per layer: from * nodes + to, layer 0 empty
  std::vector<double> to_go;               // heuristic behind each layer
};

Layers prepare(const ModeGraph& graph) {
  const std::size_t n = graph.node.size();
  Layers layers{{0}, std::vector<std::vector<double>>(n), std::vector<double>(n, 0.0)};
  for (std::size_t j = 0; j < n; ++j)
    layers.first.push_back(layers.first[j] + graph.node[j].size());
  for (std::size_t j = 1; j < n; ++j) {
    const std::size_t from_count = graph.node[j - 1].size(), to_count = graph.node[j].size();
    for (std::size_t from = 0; from < from_count; ++from)
      for (std::size_t to = 0; to < to_count; ++to)
        layers.edges[j].push_back(graph.edge(j, from, to));
  }
  for (std::size_t j = n; j-- > 1;)
    layers.to_go[j - 1] = layers.to_go[j] +
                          *std::min_element(graph.node[j].begin(), graph.node[j].end()) +
                          *std::min_element(layers.edges[j].begin(), layers.edges[j].end());
  return layers;
}

/// (estimate of the whole path, minus the layer, mode): at equal estimates the deeper node and
/// then the lower mode goes first.
using Open = std::tuple<double, std::ptrdiff_t, std::size_t>;

ModePath trace_back(const ModeGraph& graph, const Layers& layers,
                    const std::vector<std::size_t>& parent, std::size_t last) {
  ModePath path;
  path.mode.assign(graph.node.size(), last);
  for (std::size_t j = graph.node.size(); j-- > 1;)
    path.mode[j - 1] = parent[layers.first[j] + path.mode[j]];
  return path;
}

}  // namespace

ModePath cheapest_path(const ModeGraph& graph) {
  if (graph.node.empty()) return {};
  const Layers layers = prepare(graph);
  std::vector<double> cost(layers.first.back(), kInfinity);
  std::vector<std::size_t> parent(cost.size(), 0);
  std::vector<char> closed(cost.size(), 0);
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  for (std::size_t g = 0; g < graph.node[0].size(); ++g) {
    cost[g] = graph.node[0][g];
    open.emplace(cost[g] + layers.to_go[0], 0, g);
  }
  std::size_t expanded = 0;
  while (!open.empty()) {
    const auto [estimate, minus_layer, g] = open.top();
    open.pop();
    const auto j = std::size_t(-minus_layer);
    const std::size_t here = layers.first[j] + g;
    if (closed[here] != 0) continue;
    closed[here] = 1;
    ++expanded;
    if (j + 1 == graph.node.size()) {
      ModePath path = trace_back(graph, layers, parent, g);
      path.cost = cost[here];
      path.expanded = expanded;
      return path;
    }
    const std::size_t width = graph.node[j + 1].size();
    for (std::size_t to = 0; to < width; ++to) {
      const std::size_t there = layers.first[j + 1] + to;
      const double through =
          cost[here] + layers.edges[j + 1][g * width + to] + graph.node[j + 1][to];
      if (closed[there] != 0 || !(through < cost[there])) continue;
      cost[there] = through;
      parent[there] = g;
      open.emplace(through + layers.to_go[j + 1], -std::ptrdiff_t(j + 1), to);
    }
  }
  return {};  // not reached: every layer has a node and all costs are finite
}

}  // namespace animeme::dam
