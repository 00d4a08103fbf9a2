// The animeme graph (section VI of the paper): one layer a phone, one node a mode, and the
// cheapest path through it by A*.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace animeme::dam {

/// Costs of a layered graph. All must be finite and >= 0.
struct ModeGraph {
  std::vector<std::vector<double>> node;  ///< node[j][g], at least one per layer
  /// Cost of the edge from node `from` of layer j - 1 to node `to` of layer j, j >= 1.
  std::function<double(std::size_t j, std::size_t from, std::size_t to)> edge;
};

struct ModePath {
  std::vector<std::size_t> mode;  ///< one node a layer
  double cost = 0;
  std::size_t expanded = 0;  ///< nodes taken from the open list
};

/// The path with the smallest sum of node and edge costs. The heuristic is the sum of the cheapest
/// node and the cheapest edge of every layer to come: never more than the true cost, so the path
/// is optimal. Of equally cheap ones it is the same on every machine.
/// Time O(E log E) in the number of edges, each edge cost computed once.
ModePath cheapest_path(const ModeGraph& graph);

}  // namespace animeme::dam
