/// @file
/// A minimum-degree ordering; its fill is compared.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "algorithms.hpp"
#include "lean/minimum_degree.hpp"

namespace ductile::bench::irregular {

namespace {

struct Result {
  lean::Ordering ordering;

  friend bool operator==(const Result& one, const Result& two) {
    return one.ordering.order == two.ordering.order && one.ordering.fill == two.ordering.fill;
  }
};

/// Each vertex once, and at most a twentieth more fill than the serial code's.
std::string fault(const GraphInput& input, const Result& result, const Result& serial) {
  std::vector<std::uint8_t> seen(input.view().vertex_count());
  for (const example::Vertex vertex : result.ordering.order)
    if (vertex >= seen.size() || std::exchange(seen[vertex], 1) != 0) return "gives no ordering";
  if (result.ordering.order.size() != seen.size()) return "leaves vertices out";
  return unless(20 * result.ordering.fill <= 21 * serial.ordering.fill, "gives too much fill");
}

}  // namespace

Algorithm minimum_degree() {
  return algorithm(Row<GraphInput, Result>{
      .name = "minimum_degree",
      .inputs = {"grid", "geometric"},
      .make_input = graph_input,
      .serial = [](const GraphInput& input,
                   Result& result) { result.ordering = lean::MinimumDegree(input.view()).run(); },
      .fault = fault});
}

}  // namespace ductile::bench::irregular
