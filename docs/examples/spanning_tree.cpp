/// @file
/// The minimum spanning tree of spanning_tree.hpp on a grid, compared with Kruskal's algorithm on
/// one thread and between thread counts.

#include <cstdint>
#include <cstdio>
#include <vector>

#include "example.hpp"
#include "graphs.hpp"
#include "lean/kruskal.hpp"
#include "spanning_tree.hpp"

namespace {

namespace runtime = ductile::runtime;

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows grid = example::grid_graph(arguments.size);
  const std::size_t vertex_count = grid.view().vertex_count();
  const std::vector<example::Edge> edges = example::edges_of(grid.view());
  const std::vector<example::Weight> weights = example::weights_of(edges);
  std::printf("The minimum spanning tree of %zu vertices with %zu edges\n", vertex_count,
              edges.size());

  const auto tree = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::spanning_tree_in_parallel(executor, vertex_count, edges, weights, &report);
      });
  std::vector<std::uint32_t> lightest;
  example::print_yardstick("serial: Kruskal's algorithm", example::seconds_of([&] {
                             lightest = lean::kruskal(vertex_count, edges, weights);
                           }));
  example::require(tree == lightest, "not the minimum spanning tree");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
