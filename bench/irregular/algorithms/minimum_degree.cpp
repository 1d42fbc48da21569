/// @file
/// A minimum-degree ordering; its fill is compared.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "algorithms.hpp"
#include "lean/minimum_degree.hpp"
#include "minimum_degree.hpp"

namespace ductile::bench::irregular {

namespace {

using example::Ordering;

/// Checks that each vertex occurs once, and that the fill exceeds the serial code's by at most a
/// twentieth.
std::string fault(const GraphInput& input, const Ordering& result, const Ordering& serial) {
  std::vector<std::uint8_t> seen(input.view().vertex_count());
  for (const example::Vertex vertex : result.order)
    if (vertex >= seen.size() || std::exchange(seen[vertex], 1) != 0) return "gives no ordering";
  if (result.order.size() != seen.size()) return "leaves vertices out";
  return unless(20 * result.fill <= 21 * serial.fill, "gives too much fill");
}

}  // namespace

Algorithm minimum_degree() {
  return algorithm(Row<GraphInput, Ordering>{
      .name = "minimum_degree",
      .inputs = {"grid", "geometric"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, Ordering& result) {
            lean::Ordering ordering = lean::MinimumDegree(input.view()).run();
            result = {std::move(ordering.order), ordering.fill};
          },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, Ordering& result) {
            result = example::minimum_degree_in_parallel(executor, input.view());
          },
      .fault = fault});
}

}  // namespace ductile::bench::irregular
