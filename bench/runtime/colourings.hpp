/// @file
/// add_colourings: adds a candidate that colours graphs, for all graphs, and checks its colourings.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "support/add.hpp"
#include "support/extent.hpp"
#include "support/graphs.hpp"

#include "ductile/runtime/colouring/colouring.hpp"

namespace ductile::bench {

/// Sizes of graphs, as powers of 2; more than one in the full extent.
inline std::vector<unsigned> graph_scales() {
  return by_extent<std::vector<unsigned>>({14}, {20}, {17, 20, 22});
}

/// Adds a candidate: `make(rows, threads)` returns a function that colours these rows and returns a
/// runtime::Colouring. Counter: colours.
template <class Make>
void add_colourings(const std::string& candidate, const std::vector<int>& threads_of, Make make) {
  for (const unsigned scale : graph_scales())
    for (const GraphCase& graph_case : graph_cases())
      add("colouring/" + graph_case.name + "_2^" + std::to_string(scale) + '/' + candidate,
          threads_of, [&graph_case, scale, make](benchmark::State& state, int threads) {
            const Rows& graph = graph_of(graph_case, scale);
            auto colour = make(graph, threads);
            runtime::Colouring colouring;
            for (auto _ : state) colouring = colour();
            if (!is_proper(runtime::Executor({.threads = 1}), graph.view(), colouring))
              state.SkipWithError("neighbours have the same colour");
            state.counters["colours"] = colouring.count;
          });
}

/// Adds the candidates of Kokkos Kernels. They have a file of their own, because it is built only
/// where that is installed.
void add_kokkos_colourings();

}  // namespace ductile::bench
