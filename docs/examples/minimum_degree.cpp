/// @file
/// The minimum-degree ordering of minimum_degree.hpp on a grid, compared with one vertex after the
/// other and between thread counts.

#include <cstdint>
#include <cstdio>
#include <vector>

#include "example.hpp"
#include "graphs.hpp"
#include "lean/minimum_degree.hpp"
#include "minimum_degree.hpp"

namespace {

namespace runtime = ductile::runtime;

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows grid = example::grid_graph(arguments.size);
  const runtime::CsrGraph<> graph = grid.view();
  std::printf("An ordering of %zu vertices with %zu edges\n", graph.vertex_count(),
              graph.neighbour.size() / 2);

  const example::Ordering ordering = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return example::minimum_degree_in_parallel(executor, graph, &report);
      });
  lean::Ordering serial;
  example::print_yardstick("serial: one vertex after the other",
                           example::seconds_of([&] { serial = lean::MinimumDegree(graph).run(); }));
  std::printf("entries of the factor: %llu, serially %llu\n",
              static_cast<unsigned long long>(ordering.fill),
              static_cast<unsigned long long>(serial.fill));
  example::require(ordering.order.size() == graph.vertex_count(), "vertices are left out");
  example::require(20 * ordering.fill <= 21 * serial.fill, "too much fill");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 90000, compare);
}
