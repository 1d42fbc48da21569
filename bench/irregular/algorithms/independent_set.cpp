/// @file
/// A maximal independent set.
#include "independent_set.hpp"
#include "algorithms.hpp"
#include "lean/independent_set.hpp"

namespace ductile::bench::irregular {

Algorithm independent_set() {
  return algorithm(Row<GraphInput, std::vector<std::uint8_t>>{
      .name = "independent_set",
      .inputs = {"random", "rmat", "grid", "geometric"},
      .make_input = graph_input,
      .serial = [](const GraphInput& input,
                   auto& member) { member = lean::independent_set(input.view()); },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, auto& member) {
            member = example::independent_set_in_parallel(executor, input.view());
          },
      .fault =
          [](const GraphInput& /*input*/, const auto& member, const auto& serial) {
            return unless(member == serial, "gives another set than serial code");
          }});
}

}  // namespace ductile::bench::irregular
