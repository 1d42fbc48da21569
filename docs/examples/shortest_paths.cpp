/// @file
/// The shortest paths of shortest_paths.hpp among points in the plane, compared with Dijkstra's
/// algorithm on one thread and between thread counts.

#include <cstdint>
#include <cstdio>
#include <vector>

#include "example.hpp"
#include "graphs.hpp"
#include "lean/shortest_paths.hpp"
#include "shortest_paths.hpp"

namespace {

namespace runtime = ductile::runtime;

void compare(const example::Arguments& arguments) {
  const example::WeightedGraph points = example::geometric_graph(arguments.size);
  const runtime::CsrGraph<> graph = points.rows.view();
  std::printf("Shortest paths among %zu vertices with %zu edges\n", graph.vertex_count(),
              graph.neighbour.size() / 2);

  const auto distance_of = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::shortest_paths_in_parallel(executor, graph, points.weight_of, 0, &report);
      });
  std::vector<std::uint32_t> serial;
  example::print_yardstick("serial: Dijkstra's algorithm", example::seconds_of([&] {
                             serial = lean::shortest_paths(graph, points.weight_of, 0);
                           }));
  example::require(distance_of == serial, "Dijkstra's algorithm finds other distances");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
