#include "ductile/runtime/colouring/boost_graph.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/adjacency_matrix.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "graphs.hpp"

namespace ductile::runtime::boost_graph_test {
namespace {

template <class G>
void expect_same_colours(const test::TestGraph& expected, const G& graph) {
  const Executor executor({.threads = 2});
  const BoostGraph adapted(graph);
  static_assert(Graph<BoostGraph<G>>);
  const Colouring colouring = colour(executor, adapted);
  EXPECT_TRUE(is_proper(executor, adapted, colouring));
  EXPECT_EQ(colouring.colour_of, colour(executor, expected.view()).colour_of);
}

TEST(BoostGraph, IsColouredLikeTheSameGraphInRows) {
  const auto graph = test::random_graph(5000, 20000, 7);
  boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS> undirected(5000);
  boost::adjacency_list<boost::listS, boost::vecS, boost::directedS> directed(5000);
  test::Edges both;
  for (const auto& [u, v] : graph.edges) {
    add_edge(u, v, undirected);
    add_edge(u, v, directed);
    add_edge(v, u, directed);
    both.emplace_back(u, v);
    both.emplace_back(v, u);
  }
  expect_same_colours(graph, undirected);
  expect_same_colours(graph, directed);
  const boost::compressed_sparse_row_graph<boost::directedS> rows(
      boost::edges_are_unsorted_multi_pass, both.begin(), both.end(), 5000);
  expect_same_colours(graph, rows);
}

TEST(BoostGraph, UsesTheIndexOfVerticesThatAreNotNumbers) {
  using Index = boost::property<boost::vertex_index_t, std::size_t>;
  boost::adjacency_list<boost::setS, boost::listS, boost::undirectedS, Index> listed;
  std::vector<decltype(listed)::vertex_descriptor> vertex;
  for (std::size_t i = 0; i < 50; ++i) vertex.push_back(add_vertex(Index(i), listed));
  boost::adjacency_matrix<boost::undirectedS> matrix(50);
  const auto graph = test::random_graph(50, 200, 8);
  for (const auto& [u, v] : graph.edges) {
    add_edge(vertex[u], vertex[v], listed);
    add_edge(u, v, matrix);
  }
  expect_same_colours(graph, listed);
  expect_same_colours(graph, matrix);
}

}  // namespace
}  // namespace ductile::runtime::boost_graph_test
