/// @file
/// The core numbers of core_numbers.hpp, compared with Boost.Graph's and between thread counts.

#include <algorithm>
#include <cstdio>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/core_numbers.hpp>

#include "core_numbers.hpp"
#include "example.hpp"
#include "graphs.hpp"

namespace {

using example::Vertex;
namespace runtime = ductile::runtime;

/// Core numbers by Boost.Graph.
std::vector<std::uint32_t> boost_core_numbers(runtime::CsrGraph<> graph) {
  using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;
  Graph copy(graph.vertex_count());
  for (Vertex a = 0; a < graph.vertex_count(); ++a)
    graph.for_each_neighbour(a, [&](Vertex b) {
      if (a < b) add_edge(a, b, copy);
    });
  std::vector<std::uint32_t> core_of(graph.vertex_count());
  const double seconds = example::seconds_of([&] {
    boost::core_numbers(
        copy, boost::make_iterator_property_map(core_of.begin(), get(boost::vertex_index, copy)));
  });
  example::print_yardstick("Boost.Graph, one thread", seconds);
  return core_of;
}

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows random_graph =
      example::random_graph(runtime::Executor(), arguments.size, 8 * arguments.size);
  const runtime::CsrGraph<> graph = random_graph.view();
  std::printf("Core numbers of %zu vertices with %zu edges\n", graph.vertex_count(),
              graph.neighbour.size() / 2);
  const auto core_of = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::core_numbers_in_parallel(executor, graph, &report);
      });
  std::printf("greatest core number: %u\n", *std::max_element(core_of.begin(), core_of.end()));
  example::require(core_of == boost_core_numbers(graph), "Boost.Graph finds other core numbers");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
