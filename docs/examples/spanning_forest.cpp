/// @file
/// The spanning forest of spanning_forest.hpp, compared with one edge after the other and between
/// thread counts.

#include <cstdint>
#include <cstdio>
#include <vector>

#include "example.hpp"
#include "graphs.hpp"
#include "lean/spanning_forest.hpp"
#include "spanning_forest.hpp"

namespace {

namespace runtime = ductile::runtime;

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows graph =
      example::random_graph(runtime::Executor(), arguments.size, 4 * arguments.size);
  const std::vector<example::Edge> edges = example::shuffled(example::edges_of(graph.view()));
  std::printf("A spanning forest of %zu vertices with %zu edges\n", arguments.size, edges.size());
  const auto found = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::spanning_forest_in_parallel(executor, arguments.size, edges, &report);
      });
  std::vector<std::uint32_t> serial;
  example::print_yardstick("serial: one edge after the other", example::seconds_of([&] {
                             serial = lean::spanning_forest(arguments.size, edges);
                           }));
  std::printf("edges of the forest: %zu\n", found.size());
  example::require(found == serial, "the serial ones are others");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
