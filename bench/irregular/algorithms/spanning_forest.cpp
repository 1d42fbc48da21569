/// @file
/// A spanning forest.
#include <cstdint>
#include <vector>

#include "algorithms.hpp"
#include "lean/spanning_forest.hpp"
#include "spanning_forest.hpp"

namespace ductile::bench::irregular {

Algorithm spanning_forest() {
  return algorithm(Row<GraphInput, std::vector<std::uint32_t>>{
      .name = "spanning_forest",
      .inputs = {"random", "shuffled-random", "shuffled-rmat", "grid", "shuffled-grid"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, auto& forest) {
            forest = lean::spanning_forest(input.view().vertex_count(), input.edges);
          },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, auto& forest) {
            forest = example::spanning_forest_in_parallel(executor, input.view().vertex_count(),
                                                          input.edges);
          },
      .fault =
          [](const GraphInput& /*input*/, const auto& forest, const auto& serial) {
            return unless(forest == serial, "gives another forest than serial code");
          }});
}

}  // namespace ductile::bench::irregular
