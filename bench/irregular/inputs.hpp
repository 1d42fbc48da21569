/// @file
/// Inputs of the algorithms, by name and size, and their files in other programs' formats.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "graphs.hpp"
#include "plane.hpp"

namespace ductile::bench::irregular {

/// A graph, its edges as a list, and weights.
struct GraphInput {
  example::WeightedGraph graph;
  std::vector<example::Edge> edges;
  std::vector<example::Weight> edge_weights;  // [edge], of all 32 bits: example::weight_of()

  runtime::CsrGraph<> view() const { return graph.rows.view(); }
};

/// Makes the graph "random" (4 edges per vertex), "rmat" (8 edges per vertex), "grid" or
/// "geometric", with about `size` vertices. With the prefix "shuffled-", its list of edges is in
/// random order. Throws std::invalid_argument for another name.
GraphInput graph_input(const std::string& name, std::size_t size);

/// Text formats of PBBS, and the formats of Galois.
enum class Format { adjacency, edges, weighted_edges, points, galois, galois_weighted };

/// Writes the input, or writes nothing and returns false if it has no such format.
bool write_input(std::ostream& out, Format format, const GraphInput& input);
bool write_input(std::ostream& out, Format format, const std::vector<example::Point>& points);
template <class Other>
bool write_input(std::ostream&, Format, const Other&) {
  return false;
}

}  // namespace ductile::bench::irregular
