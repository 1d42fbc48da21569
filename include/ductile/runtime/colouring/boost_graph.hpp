/// @file
/// BoostGraph: adapts a Boost.Graph graph. It must be a VertexListGraph and an AdjacencyGraph or
/// IncidenceGraph, with a vertex_index property. Only users of this header need Boost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <boost/graph/graph_traits.hpp>
#include <boost/graph/properties.hpp>

namespace ductile::runtime {

/// Keeps a reference to the graph. The edges are symmetric: an undirected graph, or a directed one
/// with every edge in both directions.
template <class G>
class BoostGraph {
 public:
  explicit BoostGraph(const G& graph) : graph_(&graph), vertex_of_(num_vertices(graph)) {
    const auto [begin, end] = vertices(graph);
    for (auto v = begin; v != end; ++v) vertex_of_[index_of(*v)] = *v;
  }

  std::size_t vertex_count() const { return vertex_of_.size(); }

  template <class Visit>
  void for_each_neighbour(std::uint32_t v, Visit&& visit) const {
    if constexpr (is_adjacency_graph) {
      const auto [begin, end] = adjacent_vertices(vertex_of_[v], *graph_);
      for (auto u = begin; u != end; ++u) visit(index_of(*u));
    } else {
      const auto [begin, end] = out_edges(vertex_of_[v], *graph_);
      for (auto e = begin; e != end; ++e) visit(index_of(target(*e, *graph_)));
    }
  }

 private:
  using Vertex = typename boost::graph_traits<G>::vertex_descriptor;
  static constexpr bool is_adjacency_graph =
      std::is_convertible_v<typename boost::graph_traits<G>::traversal_category,
                            boost::adjacency_graph_tag>;

  std::uint32_t index_of(Vertex v) const {
    return static_cast<std::uint32_t>(get(boost::vertex_index, *graph_, v));
  }

  const G* graph_;
  std::vector<Vertex> vertex_of_;  // [index]
};

}  // namespace ductile::runtime
