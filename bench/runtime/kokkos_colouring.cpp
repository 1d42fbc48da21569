/// @file
/// Colourings by Kokkos Kernels, on as many threads as its default execution space has; where it
/// was built without threads, as in Debian, that is one.

#include "colourings.hpp"

#include <KokkosGraph_Distance1Color.hpp>
#include <KokkosKernels_Handle.hpp>
#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>

namespace ductile::bench {
namespace {

using Space = Kokkos::DefaultHostExecutionSpace;
using Index = int;  // vertices and entries: what its libraries are commonly compiled for
using Rowmap = Kokkos::View<Index*, Space>;
using Handle =
    KokkosKernels::Experimental::KokkosKernelsHandle<Index, Index, double, Space,
                                                     Space::memory_space, Space::memory_space>;

/// Copies of a graph's arrays, in its own types.
struct KokkosRows {
  explicit KokkosRows(const Rows& rows)
      : offset("offset", rows.offset.size()), neighbour("neighbour", rows.neighbour.size()) {
    std::copy(rows.offset.begin(), rows.offset.end(), offset.data());
    std::copy(rows.neighbour.begin(), rows.neighbour.end(), neighbour.data());
  }
  Rowmap offset, neighbour;
};

runtime::Colouring colour_by_kokkos(const KokkosRows& rows,
                                    KokkosGraph::ColoringAlgorithm algorithm) {
  const auto count = static_cast<Index>(rows.offset.extent(0)) - 1;
  Handle handle;
  handle.create_graph_coloring_handle(algorithm);
  KokkosGraph::Experimental::graph_color(&handle, count, count, rows.offset, rows.neighbour);
  const auto colours = handle.get_graph_coloring_handle()->get_vertex_colors();
  runtime::Colouring colouring;
  colouring.colour_of.resize(static_cast<std::size_t>(count));
  for (std::size_t v = 0; v < colouring.colour_of.size(); ++v) {
    colouring.colour_of[v] = static_cast<std::uint32_t>(colours(v)) - 1;  // theirs begin at 1
    colouring.count = std::max(colouring.count, colouring.colour_of[v] + 1);
  }
  handle.destroy_graph_coloring_handle();
  return colouring;
}

void add_kokkos(const std::string& name, KokkosGraph::ColoringAlgorithm algorithm) {
  add_colourings("kokkos." + name, {static_cast<int>(Space().concurrency())},
                 [algorithm](const Rows& graph, int) {
                   return [rows = std::make_shared<KokkosRows>(graph), algorithm] {
                     return colour_by_kokkos(*rows, algorithm);
                   };
                 });
}

}  // namespace

void add_kokkos_colourings() {
  static const Kokkos::ScopeGuard kokkos;  // alive until the program ends
  add_kokkos("serial", KokkosGraph::COLORING_SERIAL);
  add_kokkos("vertex_based", KokkosGraph::COLORING_VB);
  add_kokkos("vertex_based_bits", KokkosGraph::COLORING_VBBIT);
  add_kokkos("edge_based", KokkosGraph::COLORING_EB);
}

}  // namespace ductile::bench
