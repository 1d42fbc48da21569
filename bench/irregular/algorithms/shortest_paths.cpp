/// @file
/// Shortest paths from vertex 0.
#include <cstdint>
#include <vector>

#include "algorithms.hpp"
#include "lean/shortest_paths.hpp"
#include "shortest_paths.hpp"

namespace ductile::bench::irregular {

namespace {

using Distances = std::vector<std::uint32_t>;

/// Checks that no arc shortens a path, and that each reached vertex has an arc that gives its
/// distance.
bool are_shortest(const GraphInput& input, const Distances& distance_of) {
  const auto graph = input.view();
  for (example::Vertex vertex = 0; vertex < graph.vertex_count(); ++vertex) {
    bool is_reached = vertex == 0;
    for (std::uint32_t arc = graph.offset[vertex]; arc < graph.offset[vertex + 1]; ++arc) {
      const std::uint64_t before = distance_of[graph.neighbour[arc]];
      const std::uint64_t through = before + input.graph.weight_of[arc];
      if (before == lean::unreachable) continue;
      if (through < distance_of[vertex]) return false;
      is_reached |= through == distance_of[vertex];
    }
    if (is_reached != (distance_of[vertex] != lean::unreachable)) return false;
  }
  return distance_of.front() == 0;
}

}  // namespace

Algorithm shortest_paths() {
  return algorithm(Row<GraphInput, Distances>{
      .name = "shortest_paths",
      .inputs = {"geometric", "rmat", "grid"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, Distances& distance_of) {
            distance_of = lean::shortest_paths(input.view(), input.graph.weight_of, 0);
          },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, Distances& distance_of) {
            distance_of = example::shortest_paths_in_parallel(executor, input.view(),
                                                              input.graph.weight_of, 0);
          },
      .fault =
          [](const GraphInput& input, const Distances& distance_of, const Distances& /*serial*/) {
            return unless(are_shortest(input, distance_of), "gives paths that are not shortest");
          }});
}

}  // namespace ductile::bench::irregular
