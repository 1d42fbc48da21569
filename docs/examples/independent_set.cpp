/// @file
/// The maximal independent set of independent_set.hpp, compared with one vertex after the other and
/// between thread counts.

#include <cstdio>
#include <numeric>
#include <vector>

#include "example.hpp"
#include "graphs.hpp"
#include "independent_set.hpp"

namespace {

using example::Vertex;
namespace runtime = ductile::runtime;

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows random_graph =
      example::random_graph(runtime::Executor(), arguments.size, 4 * arguments.size);
  const runtime::CsrGraph<> graph = random_graph.view();
  std::vector<Vertex> vertices(graph.vertex_count());
  std::iota(vertices.begin(), vertices.end(), Vertex{0});
  std::printf("A maximal independent set of %zu vertices with %zu edges\n", vertices.size(),
              random_graph.neighbour.size() / 2);

  const auto member = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::independent_set_in_parallel(executor, graph, &report);
      });
  example::IndependentSet serial(graph);
  const double seconds =
      example::seconds_of([&] { example::OneByOne<example::IndependentSet>(serial, vertices); });
  example::print_yardstick("serial: one vertex after the other", seconds);
  std::printf("members: %d, serial %d\n", std::accumulate(member.begin(), member.end(), 0),
              std::accumulate(serial.member.begin(), serial.member.end(), 0));
  example::require(example::is_maximal_independent(graph, member), "not a maximal independent set");
  example::require(example::is_maximal_independent(graph, serial.member),
                   "the serial check is wrong");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
