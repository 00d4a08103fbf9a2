#include "dam/kinds/animeme/mode_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/kinds/animeme/contexts.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace mode_graph_test {

struct Exhaustive {
  double cost = 1e300;
  std::vector<std::size_t> path;
};

void search(const ModeGraph& graph, std::vector<std::size_t>& path, double cost, Exhaustive& best) {
  const std::size_t j = path.size();
  if (j == graph.node.size()) {
    if (cost < best.cost) best = {cost, path};
    return;
  }
  for (std::size_t g = 0; g < graph.node[j].size(); ++g) {
    const double edge = j == 0 ? 0 : graph.edge(j, path.back(), g);
    path.push_back(g);
    search(graph, path, cost + edge + graph.node[j][g], best);
    path.pop_back();
  }
}

TEST(CheapestPath, AgreesWithExhaustiveSearch) {
  test::Uniform random(11);
  for (int round = 0; round < 200; ++round) {
    ModeGraph graph;
    const std::size_t layers = 1 + random.below(6);
    for (std::size_t j = 0; j < layers; ++j) {
      graph.node.emplace_back(1 + random.below(4));
      for (double& cost : graph.node.back()) cost = random(0, 10);
    }
    std::vector<double> edges(layers * 16);
    for (double& cost : edges) cost = random(0, 10);
    graph.edge = [&](std::size_t j, std::size_t a, std::size_t b) {
      return edges[j * 16 + a * 4 + b];
    };
    Exhaustive best;
    std::vector<std::size_t> path;
    search(graph, path, 0, best);
    const ModePath found = cheapest_path(graph);
    EXPECT_EQ(found.mode, best.path);
    EXPECT_NEAR(found.cost, best.cost, 1e-9);
  }
}

TEST(CheapestPath, TiesGoToTheLowestModes) {
  ModeGraph graph;
  graph.node.assign(5, {1.0, 1.0, 1.0});
  graph.edge = [](std::size_t, std::size_t, std::size_t) { return 0.5; };
  EXPECT_THAT(cheapest_path(graph).mode, testing::ElementsAre(0u, 0u, 0u, 0u, 0u));
}

TEST(CheapestPath, WithoutEdgeCostsExpandsOneNodeALayer) {
  ModeGraph graph;
  for (std::size_t j = 0; j < 300; ++j) graph.node.push_back({2.0, double(j % 3), 5.0});
  graph.edge = [](std::size_t, std::size_t, std::size_t) { return 0.0; };
  EXPECT_EQ(cheapest_path(graph).expanded, 300u);
  EXPECT_TRUE(cheapest_path({}).mode.empty());
}

AnimemePhone two_modes() {
  AnimemePhone phone;
  phone.modes.resize(2);
  // Between phones 0 and 1 (classes 5 and 6) always mode 0, after phone 2 (class 5) mode 0, too.
  phone.contexts = {{0, 1, 0, 20}, {2, 3, 0, 5}, {4, 3, 1, 30}};
  return phone;
}

TEST(ModeCosts, FollowContextAndBackOff) {
  const std::vector<std::uint32_t> classes = {5, 6, 5, 7, 8};
  const auto known = mode_costs(two_modes(), classes, 0, 1);
  EXPECT_LT(known[0], known[1]);
  EXPECT_LT(known[0], 0.15);
  const auto same_classes = mode_costs(two_modes(), classes, 2, 1);  // pair never seen
  EXPECT_LT(same_classes[0], same_classes[1]);
  const auto unknown = mode_costs(two_modes(), classes, kRestContext, kRestContext);
  EXPECT_LT(unknown[1], unknown[0]);  // the more common mode
  double sum = 0;
  for (const double cost : unknown) sum += std::exp(-cost);
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(ModeCosts, LeavingOneOutMakesItLessLikely) {
  const std::vector<std::uint32_t> classes = {5, 6, 5, 7, 8};
  AnimemePhone phone = two_modes();
  phone.contexts.push_back({1, 1, 1, 1});
  const auto with = mode_costs(phone, classes, 1, 1);
  const auto without = mode_costs(phone, classes, 1, 1, 1);
  EXPECT_GT(without[1], with[1]);
}

}  // namespace mode_graph_test
}  // namespace animeme::dam
