/// @file
/// What the algorithms work on, by name and size, and the formats of other programs.
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

/// "random", 4 edges for each vertex; "rmat", 8 edges; "grid"; "geometric". `size` is about how
/// many vertices there are. After "shuffled-" their list of edges is in a random order. Throws
/// std::invalid_argument for another name.
GraphInput graph_input(const std::string& name, std::size_t size);

/// Formats of PBBS, as text, and of Galois.
enum class Format { adjacency, edges, weighted_edges, points, galois, galois_weighted };

/// False, with nothing written, if the input has no such format.
bool write_input(std::ostream& out, Format format, const GraphInput& input);
bool write_input(std::ostream& out, Format format, const std::vector<example::Point>& points);
template <class Other>
bool write_input(std::ostream&, Format, const Other&) {
  return false;
}

}  // namespace ductile::bench::irregular
