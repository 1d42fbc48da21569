/// @file
/// Kruskal's minimum spanning tree by Boost.Graph, for an example to be compared with.
#pragma once

#include <algorithm>
#include <iterator>
#include <type_traits>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/kruskal_min_spanning_tree.hpp>

#include "ductile/runtime/graph.hpp"
#include "example.hpp"
#include "graphs.hpp"

namespace example {

/// The weights of the tree's edges, ascending; weight_of(a, b) is that of an edge. Prints how long
/// it took.
template <class WeightOf>
auto kruskal(ductile::runtime::CsrGraph<> graph, WeightOf&& weight_of) {
  using Length = std::invoke_result_t<WeightOf, Vertex, Vertex>;
  using Weighted = boost::property<boost::edge_weight_t, Length>;
  boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property, Weighted>
      copy(graph.vertex_count());
  for (Vertex a = 0; a < graph.vertex_count(); ++a)
    graph.for_each_neighbour(a, [&](Vertex b) {
      if (a < b) add_edge(a, b, weight_of(a, b), copy);
    });
  std::vector<typename decltype(copy)::edge_descriptor> tree;
  const double seconds =
      seconds_of([&] { boost::kruskal_minimum_spanning_tree(copy, std::back_inserter(tree)); });
  print_yardstick("Boost.Graph, Kruskal, one thread", seconds);
  std::vector<Length> weights(tree.size());
  std::transform(tree.begin(), tree.end(), weights.begin(),
                 [&](const auto& edge) { return get(boost::edge_weight, copy, edge); });
  std::sort(weights.begin(), weights.end());
  return weights;
}

}  // namespace example
