/// @file
/// The minimum spanning tree of spanning_tree.hpp on a grid, compared with one contraction after
/// the other, with Kruskal's algorithm and between thread counts.

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "example.hpp"
#include "graphs.hpp"
#include "lean/kruskal.hpp"
#include "spanning_tree.hpp"

namespace {

using example::Vertex;
namespace runtime = ductile::runtime;

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows grid = example::grid_graph(arguments.size);
  const runtime::CsrGraph<> graph = grid.view();
  std::vector<Vertex> vertices(graph.vertex_count());
  std::iota(vertices.begin(), vertices.end(), Vertex{0});
  std::printf("The minimum spanning tree of %zu vertices with %zu edges\n", vertices.size(),
              graph.neighbour.size() / 2);

  auto tree = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::spanning_tree_in_parallel(executor, graph, &report);
      });
  const double seconds = example::seconds_of([&] {
    example::Contraction contraction(runtime::Executor({.threads = 1}), graph);
    example::OneByOne<example::Contraction>(contraction, vertices);
  });
  example::print_yardstick("serial: one contraction after the other", seconds);
  std::erase(tree, example::Weight{0});
  std::sort(tree.begin(), tree.end());
  std::printf("edges in the tree: %zu\n", tree.size());

  const std::vector<example::Edge> edges = example::edges_of(graph);
  const std::vector<example::Weight> weights = example::weights_of(edges);
  std::vector<std::uint32_t> lightest;
  const double kruskal_seconds =
      example::seconds_of([&] { lightest = lean::kruskal(graph.vertex_count(), edges, weights); });
  example::print_yardstick("serial: Kruskal's algorithm", kruskal_seconds);
  const bool is_lightest =
      std::equal(tree.begin(), tree.end(), lightest.begin(), lightest.end(),
                 [&](example::Weight weight, std::uint32_t e) { return weight == weights[e]; });
  example::require(is_lightest, "not the minimum spanning tree");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
