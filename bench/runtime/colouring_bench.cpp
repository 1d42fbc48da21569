/// @file
/// Colouring of graphs of about a million vertices, by every method, beside serial first-fit and a
/// bare sweep over all neighbours' bytes. Counters: colours.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring.hpp"
#include "ductile/runtime/hash.hpp"

namespace {

using namespace ductile::runtime;

struct Rows {
  std::vector<std::uint32_t> offset, neighbour;
  CsrGraph<> view() const { return {offset, neighbour}; }
};
using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Rows rows(std::uint32_t vertices, const Edges& edges) {
  Rows graph{std::vector<std::uint32_t>(vertices + 1), {}};
  for (const auto& [u, v] : edges) ++graph.offset[u + 1], ++graph.offset[v + 1];
  std::partial_sum(graph.offset.begin(), graph.offset.end(), graph.offset.begin());
  graph.neighbour.resize(graph.offset.back());
  std::vector<std::uint32_t> next = graph.offset;
  for (const auto& [u, v] : edges) {
    graph.neighbour[next[u]++] = v;
    graph.neighbour[next[v]++] = u;
  }
  return graph;
}

/// A box of side^dim vertices; every cell is cut into simplices along its main diagonal (Kuhn).
Edges mesh(std::uint32_t side, int dim) {
  Edges edges;
  const std::uint32_t depth = dim == 3 ? side : 1;
  for (std::uint32_t z = 0; z < depth; ++z)
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        for (std::uint32_t step = 1; step < 8; ++step) {
          const std::uint32_t a = x + step % 2, b = y + step / 2 % 2, c = z + step / 4;
          if (a < side && b < side && c < depth)
            edges.emplace_back((z * side + y) * side + x, (c * side + b) * side + a);
        }
  return edges;
}

/// Renames vertices. By another hash than the colourings', which would see a natural order in it.
Edges in_random_order(Edges edges, std::uint32_t vertices) {
  std::vector<std::uint32_t> name(vertices);
  std::iota(name.begin(), name.end(), 0U);
  std::sort(name.begin(), name.end(), [](auto a, auto b) { return mix64(a) < mix64(b); });
  for (auto& [u, v] : edges) u = name[u], v = name[v];
  return edges;
}

/// 2^20 vertices, 2^23 edges; a, b, c of 16 are the odds of the first three quadrants.
Edges rmat(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  Edges edges(1U << 23U);
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (std::uint64_t bit = 0; bit < 20; ++bit) {
      const auto odds = static_cast<std::uint32_t>(mix64(e * 20 + bit) % 16);
      const std::uint32_t quadrant = odds < a ? 0 : odds < a + b ? 1 : odds < a + b + c ? 2 : 3;
      edges[e].first = 2 * edges[e].first + quadrant / 2;
      edges[e].second = 2 * edges[e].second + quadrant % 2;
    }
  std::erase_if(edges, [](const auto& edge) { return edge.first == edge.second; });
  return edges;
}

void report(benchmark::State& state, const Rows& graph, const Colouring& colouring) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(graph.offset.size() - 1));
  state.counters["colours"] = colouring.count;
}

void coloured(benchmark::State& state, const Rows& graph, ColouringMethod method) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  Colouring colouring;
  for (auto _ : state) colouring = colour(executor, graph.view(), method);
  if (!is_proper(executor, graph.view(), colouring)) state.SkipWithError("not a colouring");
  report(state, graph, colouring);
}

/// Recolours vertices scattered at random, `per_mille` of all.
void recoloured(benchmark::State& state, const Rows& graph, std::uint32_t per_mille) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  Colouring colouring = colour(executor, graph.view());
  std::vector<std::uint32_t> some;
  for (std::uint32_t v = 0; v < colouring.colour_of.size(); ++v)
    if (mix64(v) % 1000 < per_mille) some.push_back(v);
  for (auto _ : state) recolour(executor, graph.view(), some, colouring);
  if (!is_proper(executor, graph.view(), colouring)) state.SkipWithError("not a colouring");
  report(state, graph, colouring);
}

/// Reads a byte of every neighbour and writes one: what no colouring can avoid.
void swept(benchmark::State& state, const Rows& graph) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  std::vector<std::uint8_t> from(graph.offset.size() - 1, 1), to(from.size());
  for (auto _ : state)
    parallel_for(executor, from.size(),
                 [&](std::size_t v) {
                   unsigned all = 0;
                   graph.view().for_each_neighbour(static_cast<std::uint32_t>(v),
                                                   [&](std::uint32_t u) { all |= from[u]; });
                   to[v] = static_cast<std::uint8_t>(all);
                 },
                 {.grain = 1024});
  report(state, graph, {});
}

void register_graph(const std::string& name, Rows made) {
  // Benchmarks run until the program ends, and so do the graphs.
  static std::vector<std::unique_ptr<Rows>> kept;
  const Rows& graph = *kept.emplace_back(std::make_unique<Rows>(std::move(made)));
  const auto finish = [](benchmark::internal::Benchmark* b) {
    b->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
  };
  finish(benchmark::RegisterBenchmark((name + "/sweep").c_str(),
                                      [&graph](benchmark::State& s) { swept(s, graph); }));
  const std::pair<const char*, ColouringMethod> methods[] = {
      {"serial", ColouringMethod::serial},
      {"blocked", ColouringMethod::blocked},
      {"by_priority", ColouringMethod::by_priority},
      {"detect_again", ColouringMethod::detect_again},
      {"two_phase", ColouringMethod::two_phase}};
  for (const auto& [label, method] : methods)
    finish(benchmark::RegisterBenchmark(
        (name + "/" + label).c_str(),
        [&graph, method = method](benchmark::State& s) { coloured(s, graph, method); }));
  for (const std::uint32_t share : {1U, 10U})
    finish(benchmark::RegisterBenchmark(
        (name + "/recolour/per_mille:" + std::to_string(share)).c_str(),
        [&graph, share](benchmark::State& s) { recoloured(s, graph, share); }));
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const Edges flat = mesh(1000, 2), solid = mesh(100, 3);
  register_graph("mesh_2d", rows(1000000, flat));
  register_graph("mesh_2d_random", rows(1000000, in_random_order(flat, 1000000)));
  register_graph("mesh_3d", rows(1000000, solid));
  register_graph("mesh_3d_random", rows(1000000, in_random_order(solid, 1000000)));
  register_graph("rmat_even", rows(1U << 20U, rmat(4, 4, 4)));
  register_graph("rmat_skewed", rows(1U << 20U, rmat(9, 3, 3)));
  benchmark::RunSpecifiedBenchmarks();
}
