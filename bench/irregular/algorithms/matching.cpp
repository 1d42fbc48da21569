/// @file
/// A maximal matching.
#include <cstdint>
#include <vector>

#include "algorithms.hpp"
#include "lean/matching.hpp"
#include "matching.hpp"

namespace ductile::bench::irregular {

Algorithm matching() {
  return algorithm(Row<GraphInput, std::vector<std::uint32_t>>{
      .name = "matching",
      .inputs = {"random", "shuffled-random", "shuffled-rmat", "grid", "shuffled-grid"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, auto& matched) {
            matched = lean::matching(input.view().vertex_count(), input.edges);
          },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, auto& matched) {
            matched =
                example::matching_in_parallel(executor, input.view().vertex_count(), input.edges);
          },
      .fault =
          [](const GraphInput& /*input*/, const auto& matched, const auto& serial) {
            return unless(matched == serial, "gives another matching than serial code");
          }});
}

}  // namespace ductile::bench::irregular
