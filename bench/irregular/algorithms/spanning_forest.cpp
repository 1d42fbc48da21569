/// @file
/// A spanning forest.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "algorithms.hpp"
#include "lean/disjoint_sets.hpp"
#include "lean/spanning_forest.hpp"

namespace ductile::bench::irregular {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// Edges without a cycle, to which none can be added.
bool is_spanning_forest(const GraphInput& input, const Numbers& forest) {
  lean::DisjointSets trees(input.view().vertex_count());
  const auto joins = [&](const example::Edge& edge) { return trees.join(edge.a, edge.b); };
  return std::all_of(forest.begin(), forest.end(),
                     [&](std::uint32_t e) { return joins(input.edges[e]); }) &&
         std::none_of(input.edges.begin(), input.edges.end(), joins);
}

}  // namespace

Algorithm spanning_forest() {
  return algorithm(Row<GraphInput, Numbers>{
      .name = "spanning_forest",
      .inputs = {"random", "shuffled-random", "shuffled-rmat", "grid", "shuffled-grid"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, Numbers& forest) {
            forest = lean::spanning_forest(input.view().vertex_count(), input.edges);
          },
      .fault =
          [](const GraphInput& input, const Numbers& forest, const Numbers& /*serial*/) {
            return unless(is_spanning_forest(input, forest), "gives no spanning forest");
          }});
}

}  // namespace ductile::bench::irregular
