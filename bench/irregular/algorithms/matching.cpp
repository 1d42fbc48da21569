/// @file
/// A maximal matching.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "algorithms.hpp"
#include "lean/matching.hpp"

namespace ductile::bench::irregular {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// Edges without common ends, and none could be added.
bool is_maximal_matching(const GraphInput& input, const Numbers& matched) {
  std::vector<std::uint8_t> taken(input.view().vertex_count());
  for (const std::uint32_t e : matched)
    for (const example::Vertex end : {input.edges[e].a, input.edges[e].b})
      if (++taken[end] > 1) return false;
  return std::all_of(input.edges.begin(), input.edges.end(),
                     [&](auto edge) { return taken[edge.a] + taken[edge.b] > 0; });
}

}  // namespace

Algorithm matching() {
  return algorithm(Row<GraphInput, Numbers>{
      .name = "matching",
      .inputs = {"random", "shuffled-random", "shuffled-rmat", "grid", "shuffled-grid"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, Numbers& matched) {
            matched = lean::matching(input.view().vertex_count(), input.edges);
          },
      .fault =
          [](const GraphInput& input, const Numbers& matched, const Numbers& /*serial*/) {
            return unless(is_maximal_matching(input, matched), "gives no maximal matching");
          }});
}

}  // namespace ductile::bench::irregular
