/// @file
/// The maximal independent set of independent_set.hpp, compared with one vertex after the other and
/// between thread counts.

#include <cstdint>
#include <cstdio>
#include <numeric>
#include <vector>

#include "example.hpp"
#include "graphs.hpp"
#include "independent_set.hpp"
#include "lean/independent_set.hpp"

namespace {

namespace runtime = ductile::runtime;

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows random_graph =
      example::random_graph(runtime::Executor(), arguments.size, 4 * arguments.size);
  const runtime::CsrGraph<> graph = random_graph.view();
  std::printf("A maximal independent set of %zu vertices with %zu edges\n", graph.vertex_count(),
              random_graph.neighbour.size() / 2);

  const auto member = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::independent_set_in_parallel(executor, graph, &report);
      });
  std::vector<std::uint8_t> serial;
  example::print_yardstick("serial: one vertex after the other",
                           example::seconds_of([&] { serial = lean::independent_set(graph); }));
  std::printf("members: %d\n", std::accumulate(member.begin(), member.end(), 0));
  example::require(example::is_maximal_independent(graph, member), "not a maximal independent set");
  example::require(member == serial, "the serial set is another one");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
