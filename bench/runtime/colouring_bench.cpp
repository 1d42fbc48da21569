/// @file
/// Colourings of graphs by every method of the runtime and by other libraries. Floor: a bare sweep
/// that reads a byte of every neighbour and writes one. Also recolouring after a change, compared
/// with colouring anew.

#include <cstdint>
#include <utility>

#include <boost/graph/sequential_vertex_coloring.hpp>
#include <boost/property_map/property_map.hpp>

#include "boost_rows.hpp"
#include "colourings.hpp"

#include "ductile/runtime/hash.hpp"

namespace ductile::bench {
namespace {

using runtime::Colouring;
using runtime::ColouringMethod;
using runtime::Executor;

void sweep(benchmark::State& state, const Rows& graph, int threads) {
  const Executor executor({.threads = threads});
  std::vector<std::uint8_t> from(graph.vertex_count(), 1), to(from.size());
  for (auto _ : state)
    parallel_for(executor, from.size(),
                 [&](std::size_t v) {
                   unsigned all = 0;
                   graph.view().for_each_neighbour(static_cast<std::uint32_t>(v),
                                                   [&](std::uint32_t u) { all |= from[u]; });
                   to[v] = static_cast<std::uint8_t>(all);
                 },
                 {.grain = 1024});
}

void add_floor() {
  for (const unsigned scale : graph_scales())
    for (const GraphCase& graph_case : graph_cases())
      add("colouring/" + graph_case.name + "_2^" + std::to_string(scale) + "/floor",
          thread_counts(), [&graph_case, scale](benchmark::State& state, int threads) {
            sweep(state, graph_of(graph_case, scale), threads);
          });
}

void add_ductile(const std::string& name, ColouringMethod method, bool deterministic = true) {
  const bool serial = method == ColouringMethod::serial;
  add_colourings("ductile." + name, serial ? std::vector{1} : thread_counts(),
                 [method, deterministic](const Rows& graph, int threads) {
                   const Executor executor({.threads = threads, .deterministic = deterministic});
                   return [&graph, method, executor] {
                     return colour(executor, graph.view(), method);
                   };
                 });
}

Colouring colour_by_boost(const Rows& graph) {
  Colouring colouring;
  colouring.colour_of.resize(graph.vertex_count());
  const boost::typed_identity_property_map<std::uint32_t> natural_order;
  colouring.count = static_cast<std::uint32_t>(boost::sequential_vertex_coloring(
      BoostRows{&graph}, natural_order,
      boost::make_iterator_property_map(colouring.colour_of.begin(),
                                        boost::typed_identity_property_map<std::uint32_t>())));
  return colouring;
}

/// Recolours `per_mille` of the vertices of a graph, scattered at random.
void add_recolouring(const GraphCase& graph_case, std::uint32_t per_mille) {
  const unsigned scale = graph_scales().back();
  const std::string name = "recolouring/" + graph_case.name + "_2^" + std::to_string(scale) + '_' +
                           std::to_string(per_mille) + "_per_mille/ductile.";
  add(name + "recolour", thread_counts(),
      [&graph_case, scale, per_mille](benchmark::State& state, int threads) {
        const Rows& graph = graph_of(graph_case, scale);
        const Executor executor({.threads = threads});
        Colouring colouring = colour(executor, graph.view());
        std::vector<std::uint32_t> some;
        for (std::uint32_t v = 0; v < graph.vertex_count(); ++v)
          if (runtime::mix64(v) % 1000 < per_mille) some.push_back(v);
        for (auto _ : state) recolour(executor, graph.view(), some, colouring);
        if (!is_proper(executor, graph.view(), colouring))
          state.SkipWithError("neighbours have the same colour");
        state.counters["colours"] = colouring.count;
      });
  add(name + "colour_anew", thread_counts(),
      [&graph_case, scale](benchmark::State& state, int threads) {
        const Rows& graph = graph_of(graph_case, scale);
        const Executor executor({.threads = threads});
        Colouring colouring;
        for (auto _ : state) colouring = colour(executor, graph.view());
        state.counters["colours"] = colouring.count;
      });
}

void add_all() {
  add_floor();
  add_ductile("serial", ColouringMethod::serial);
  add_ductile("automatic", ColouringMethod::automatic);
  add_ductile("automatic_racing", ColouringMethod::automatic, false);
  add_ductile("detect_again", ColouringMethod::detect_again);
  add_ductile("two_phase", ColouringMethod::two_phase);
  add_ductile("by_priority", ColouringMethod::by_priority);
  add_colourings("boost.sequential", {1}, [](const Rows& graph, int) {
    return [&graph] { return colour_by_boost(graph); };
  });
#ifdef DUCTILE_BENCH_KOKKOS
  add_kokkos_colourings();
#endif
  for (const GraphCase& graph_case : graph_cases())
    if (graph_case.name == "mesh_2d_hilbert" || graph_case.name == "mesh_3d_hilbert")
      for (const std::uint32_t per_mille : {1U, 10U}) add_recolouring(graph_case, per_mille);
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
