/// @file
/// long_edges: finds the long edges of a mesh, or of the part that changed.
/// mark_ends_of_short_edges: finds the vertices that have a short one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "ductile/runtime/atomic_mark.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/make_vector.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

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

/// The marked vertices that have an edge shorter than a limit. Elements all of whose marked corners
/// are known to have one are not looked at.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<std::uint8_t> mark_ends_of_short_edges(const runtime::Executor& executor,
                                                   const Mesh<Dim>& mesh,
                                                   const std::vector<std::uint8_t>& marked,
                                                   double limit) {
  auto ends = runtime::make_vector<std::uint8_t>(executor, mesh.vertex_slots());
  runtime::parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    const Corners<Dim>& corners = mesh.corners_of[e];
    if (!mesh.alive(static_cast<ElementId>(e))) return;
    unsigned wanted = 0;
    for (const VertexId v : corners)
      wanted += static_cast<unsigned>(marked[v] > runtime::atomic_is_marked(ends[v]));
    if (wanted == 0) return;
    const auto sites = mesh.sites(corners);
    for (unsigned left = compare_edges<Dim>(sites, limit).shorter; left != 0; left &= left - 1) {
      const auto& edge = Simplex<Dim>::edge[static_cast<std::size_t>(std::countr_zero(left))];
      const auto i = static_cast<std::size_t>(edge[0]), j = static_cast<std::size_t>(edge[1]);
      if (!shorter_than(*sites[i], *sites[j], limit)) continue;
      for (const VertexId v : {corners[i], corners[j]})
        if (marked[v] != 0) runtime::atomic_mark(ends[v]);
    }
  });
  return ends;
}

struct LongEdge {
  VertexId a, b;  ///< a < b
  float length;
  friend auto operator<=>(const LongEdge&, const LongEdge&) = default;
};

/// Of the elements around an edge that changed after an epoch, one stands for it. Of two triangles,
/// that is the one where it goes from the lower number to the higher. `element` is one of them.
inline bool stands_for(const Mesh<2>& mesh, ElementId element, std::size_t edge,
                       std::uint32_t after) {
  const auto [p, q] = ends_of_edge<2>(mesh.corners_of[element], edge);
  if (p < q) return true;
  const ElementId other = neighbour(mesh, element, static_cast<int>((edge + 2) % 3));
  return other == none || mesh.changed_at[other] <= after;
}

/// In 3D the first.
inline bool stands_for(const Mesh<3>& mesh, ElementId element, std::size_t edge,
                       std::uint32_t after) {
  const auto [p, q] = ends_of_edge<3>(mesh.corners_of[element], edge);
  const auto of_p = mesh.elements_of.of(p), of_q = mesh.elements_of.of(q);
  for (std::size_t i = 0, j = 0;;) {
    const ElementId x = of_p[i], y = of_q[j];
    if (x == y && mesh.changed_at[x] > after) return x == element;
    i += x <= y;
    j += y <= x;
  }
}

/// The edges no shorter than a limit around which an element changed after an epoch, each once; in
/// an order that does not depend on threads.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<LongEdge> long_edges(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                                 double limit, std::uint32_t after) {
  const auto find = [&](std::size_t e, auto&& append) {
    const auto element = static_cast<ElementId>(e);
    if (mesh.changed_at[e] <= after || !mesh.alive(element)) return;
    const Corners<Dim>& corners = mesh.corners_of[e];
    unsigned left = compare_edges<Dim>(mesh.sites(corners), limit).longer;
    for (; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      const auto [p, q] = ends_of_edge<Dim>(corners, k);
      if (stands_for(mesh, element, k, after) &&
          !shorter_than(mesh.site_of[p], mesh.site_of[q], limit))
        append(LongEdge{std::min(p, q), std::max(p, q), static_cast<float>(mesh.length(p, q))});
    }
  };
  return runtime::parallel_collect<LongEdge>(executor, mesh.element_slots(), find);
}

}  // namespace ductile::meshadapt
