/// @file
/// The minimum spanning forest; its weights are compared.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "algorithms.hpp"
#include "lean/kruskal.hpp"
#include "spanning_tree.hpp"

namespace ductile::bench::irregular {

namespace {

/// Serially the numbers of the edges, by Ductile their weights in any order, and zeros.
struct Forest {
  std::vector<std::uint32_t> edges;
  std::vector<example::Weight> weights;

  friend bool operator==(const Forest&, const Forest&) = default;

  std::vector<example::Weight> ascending(const GraphInput& input) const {
    std::vector<example::Weight> result = weights;
    for (const std::uint32_t e : edges) result.push_back(input.edge_weights[e]);
    std::erase(result, example::Weight{0});
    std::sort(result.begin(), result.end());
    return result;
  }
};

}  // namespace

Algorithm spanning_tree() {
  return algorithm(Row<GraphInput, Forest>{
      .name = "spanning_tree",
      .inputs = {"grid", "geometric", "rmat"},
      .make_input = graph_input,
      .serial =
          [](const GraphInput& input, Forest& forest) {
            forest.edges =
                lean::kruskal(input.view().vertex_count(), input.edges, input.edge_weights);
          },
      .ductile =
          [](const runtime::Executor& executor, const GraphInput& input, Forest& forest) {
            forest.weights = example::spanning_tree_in_parallel(executor, input.view());
          },
      .fault =
          [](const GraphInput& input, const Forest& forest, const Forest& serial) {
            return unless(forest.ascending(input) == serial.ascending(input),
                          "gives no minimum spanning forest");
          }});
}

}  // namespace ductile::bench::irregular
