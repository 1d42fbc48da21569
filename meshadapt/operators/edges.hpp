/// @file
/// collect_edges: goes over the long edges of a mesh, or of a part of it, each once.
/// mark_ends_of_short_edges: finds the vertices that have a short one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "ductile/runtime/atomic_mark.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

/// Does this element stand for its k-th edge, from p to q? Of two triangles, the one where it goes
/// from the lower number to the higher; on the boundary there is but one.
inline bool stands_for(const Mesh<2>& mesh, ElementId element, std::size_t k, VertexId p,
                       VertexId q) {
  const std::size_t facet = (k + 2) % 3;
  return p < q || (mesh.patches_of[element][facet] != 0 &&
                   neighbour(mesh, element, static_cast<int>(facet)) == none);
}

/// In 3D, the first of those around the edge.
inline bool stands_for(const Mesh<3>& mesh, ElementId element, std::size_t, VertexId p,
                       VertexId q) {
  const auto of_p = mesh.elements_of.of(p), of_q = mesh.elements_of.of(q);
  std::size_t i = 0, j = 0;
  while (of_p[i] != of_q[j]) {
    const bool p_is_behind = of_p[i] < of_q[j];
    i += p_is_behind;
    j += !p_is_behind;
  }
  return of_p[i] == element;
}

/// Bits for those edges of an element that may be shorter than a limit, and for those that may not;
/// of the others it is certain. Decided without roots or branches: see shorter_than().
struct MaybeEdges {
  unsigned shorter = 0, longer = 0;
};
template <int Dim>
MaybeEdges compare_edges(const std::array<const Site<Dim>*, Dim + 1>& corner, double limit) {
  const double square = limit * limit;
  MaybeEdges result;
  for (unsigned k = 0; k < Simplex<Dim>::edges; ++k) {
    const auto& [i, j] = Simplex<Dim>::edge[k];
    const Site<Dim>& a = *corner[static_cast<std::size_t>(i)];
    const Site<Dim>& b = *corner[static_cast<std::size_t>(j)];
    const auto [at_a, at_b] = end_squares(a, b);
    result.shorter |= static_cast<unsigned>(at_a * at_b < square * square) << k;
    result.longer |= static_cast<unsigned>(std::max(at_a, at_b) >= square) << k;
  }
  return result;
}

template <int Dim>
bool any_marked(const std::vector<std::uint8_t>& marked, const Corners<Dim>& corners) {
  unsigned sum = 0;
  for (const VertexId v : corners) sum += marked[v];
  return sum != 0;
}

/// The ends of all edges shorter than a limit whose element has a marked corner.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<std::uint8_t> mark_ends_of_short_edges(const runtime::Executor& executor,
                                                   const Mesh<Dim>& mesh,
                                                   const std::vector<std::uint8_t>& marked,
                                                   double limit) {
  std::vector<std::uint8_t> ends(mesh.vertex_slots());
  runtime::parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    const Corners<Dim>& corners = mesh.corners_of[e];
    if (!mesh.alive(static_cast<ElementId>(e)) || !any_marked<Dim>(marked, corners)) return;
    const auto sites = mesh.sites(corners);
    for (unsigned left = compare_edges<Dim>(sites, limit).shorter; left != 0; left &= left - 1) {
      const auto& edge = Simplex<Dim>::edge[static_cast<std::size_t>(std::countr_zero(left))];
      const auto i = static_cast<std::size_t>(edge[0]), j = static_cast<std::size_t>(edge[1]);
      if (!shorter_than(*sites[i], *sites[j], limit)) continue;
      runtime::atomic_mark(ends[corners[i]]);
      runtime::atomic_mark(ends[corners[j]]);
    }
  });
  return ends;
}

/// Edges with an end among the marked vertices.
struct WantedEdges {
  const std::vector<std::uint8_t>& marked;
  double no_shorter_than = 0;  ///< metric length
};

/// Calls find(a, b, append) for every wanted edge a < b, once; append(item) adds to the result,
/// whose order does not depend on threads.
/// Thread safety: one caller; runs on the executor.
template <class Item, int Dim>
std::vector<Item> collect_edges(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                                const WantedEdges& wanted, auto&& find) {
  const std::vector<std::uint8_t>& marked = wanted.marked;
  const double limit = wanted.no_shorter_than;
  return runtime::parallel_collect<Item>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        const Corners<Dim>& corners = mesh.corners_of[e];
        if (!mesh.alive(element) || !any_marked<Dim>(marked, corners)) return;
        unsigned left = compare_edges<Dim>(mesh.sites(corners), limit).longer;
        for (; left != 0; left &= left - 1) {
          const auto k = static_cast<std::size_t>(std::countr_zero(left));
          const VertexId p = corners[static_cast<std::size_t>(Simplex<Dim>::edge[k][0])];
          const VertexId q = corners[static_cast<std::size_t>(Simplex<Dim>::edge[k][1])];
          if ((marked[p] || marked[q]) && stands_for(mesh, element, k, p, q) &&
              !shorter_than(mesh.site_of[p], mesh.site_of[q], limit))
            find(std::min(p, q), std::max(p, q), append);
        }
      });
}

}  // namespace ductile::meshadapt
