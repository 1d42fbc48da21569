/// @file
/// Core numbers.
#include "core_numbers.hpp"
#include "algorithms.hpp"
#include "lean/core_numbers.hpp"

namespace ductile::bench::irregular {

Algorithm core_numbers() {
  return algorithm(Row<GraphInput, std::vector<std::uint32_t>>{
      .name = "core_numbers",
      .inputs = {"random", "rmat", "geometric"},
      .make_input = graph_input,
      .serial = [](const GraphInput& input,
                   auto& core_of) { core_of = lean::core_numbers(input.view()); },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, auto& core_of) {
            core_of = example::core_numbers_in_parallel(executor, input.view());
          },
      .fault =
          [](const GraphInput& /*input*/, const auto& core_of, const auto& serial) {
            return unless(core_of == serial, "gives other core numbers than the serial code");
          }});
}

}  // namespace ductile::bench::irregular
