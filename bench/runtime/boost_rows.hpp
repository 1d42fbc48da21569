/// @file
/// The arrays of a graph as Boost.Graph sees them, so that its algorithms run on the same memory as
/// ours: a VertexListGraph and AdjacencyGraph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include <boost/graph/graph_traits.hpp>
#include <boost/iterator/counting_iterator.hpp>

#include "support/graphs.hpp"

namespace ductile::bench {

struct BoostRows {
  const Rows* rows;

  // ---- Boost.Graph's traits ----
  struct Traversal : boost::vertex_list_graph_tag, boost::adjacency_graph_tag {};
  using traversal_category = Traversal;
  using vertex_descriptor = std::uint32_t;
  using edge_descriptor = void;
  using directed_category = boost::undirected_tag;
  using edge_parallel_category = boost::allow_parallel_edge_tag;
  using vertices_size_type = std::size_t;
  using vertex_iterator = boost::counting_iterator<std::uint32_t>;
  using adjacency_iterator = const std::uint32_t*;
};

inline std::size_t num_vertices(const BoostRows& graph) { return graph.rows->vertex_count(); }

inline std::pair<BoostRows::vertex_iterator, BoostRows::vertex_iterator> vertices(
    const BoostRows& graph) {
  return {BoostRows::vertex_iterator(0U), BoostRows::vertex_iterator(graph.rows->vertex_count())};
}

inline std::pair<const std::uint32_t*, const std::uint32_t*> adjacent_vertices(
    std::uint32_t v, const BoostRows& graph) {
  const std::uint32_t* const all = graph.rows->neighbour.data();
  return {all + graph.rows->offset[v], all + graph.rows->offset[v + 1]};
}

}  // namespace ductile::bench
