/// @file
/// The minimum spanning forest.
#include <cstdint>
#include <vector>

#include "algorithms.hpp"
#include "lean/kruskal.hpp"
#include "spanning_tree.hpp"

namespace ductile::bench::irregular {

Algorithm spanning_tree() {
  return algorithm(Row<GraphInput, std::vector<std::uint32_t>>{
      .name = "spanning_tree",
      .inputs = {"grid", "geometric", "rmat"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, auto& forest) {
            forest = lean::kruskal(input.view().vertex_count(), input.edges, input.edge_weights);
          },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, auto& forest) {
            forest = example::spanning_tree_in_parallel(executor, input.view().vertex_count(),
                                                        input.edges, input.edge_weights);
          },
      .fault =
          [](const GraphInput& /*input*/, const auto& forest, const auto& serial) {
            return unless(forest == serial, "gives another forest than serial code");
          }});
}

}  // namespace ductile::bench::irregular
