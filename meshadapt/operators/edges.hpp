/// @file
/// long_edges: finds the long edges of a mesh, or of the part that changed.
/// mark_ends_of_short_edges: finds the vertices that have a short one.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/cavity.hpp"
#include "operators/edge_survey.hpp"

namespace ductile::meshadapt {

/// The marked vertices that have an edge shorter than a limit, which is not above that of the
/// survey. All corners of elements changed since the survey was last used are marked.
/// Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
runtime::UnsetVector<std::uint8_t> mark_ends_of_short_edges(const runtime::Executor& executor,
                                                            const Mesh<Dim, Space>& mesh,
                                                            EdgeSurvey<Dim, Space>& survey,
                                                            std::span<const std::uint8_t> marked,
                                                            double limit) {
  auto ends = runtime::make_filled<std::uint8_t>(executor, mesh.vertex_slots());
  survey.renew(executor, mesh, [&](ElementId e) {
    unsigned any = 0;
    for (const VertexId v : mesh.corners_of[e]) any |= marked[v];
    return any != 0;
  });
  const auto mark = [&](ElementId e, std::size_t k) {
    const auto [a, b] = ends_of_edge<Dim>(mesh.corners_of[e], k);
    if (marked[a] <= runtime::atomic_is_marked(ends[a]) &&
        marked[b] <= runtime::atomic_is_marked(ends[b]))
      return;
    if (!shorter_than(mesh.site_of[a], mesh.site_of[b], limit)) return;
    for (const VertexId v : {a, b})
      if (marked[v] != 0) runtime::atomic_mark(ends[v]);
  };
  const auto look = [&](std::size_t, std::size_t begin, std::size_t) {
    survey.visit_shorter(mesh, begin, mark);
  };
  runtime::parallel_for_blocks(executor, mesh.element_slots(), EdgeSurvey<Dim, Space>::stretch,
                               look, {});
  return ends;
}

struct LongEdge {
  VertexId a, b;  ///< a < b
  float length;
  friend auto operator<=>(const LongEdge&, const LongEdge&) = default;
};

/// About how many times an edge will be split.
inline std::size_t splits_of(const LongEdge& edge, double long_edge) {
  return static_cast<std::size_t>(edge.length / long_edge);
}

/// One of the elements around an edge that changed after an epoch stands for the edge. Of two
/// triangles it is the one in which the edge goes from the lower number to the higher. `element` is
/// one of them.
inline bool stands_for(const Mesh<2>& mesh, ElementId element, std::size_t edge,
                       std::uint32_t after) {
  const auto [p, q] = ends_of_edge<2>(mesh.corners_of[element], edge);
  if (p < q) return true;
  const ElementId other = neighbour(mesh, element, static_cast<int>((edge + 2) % 3));
  return other == none || mesh.changed_at[other] <= after;
}

/// In space the first.
template <int Dim>
bool stands_for(const Mesh<Dim, 3>& mesh, ElementId element, std::size_t edge,
                std::uint32_t after) {
  const auto [p, q] = ends_of_edge<Dim>(mesh.corners_of[element], edge);
  const auto of_p = mesh.elements_of.of(p), of_q = mesh.elements_of.of(q);
  const bool fewer = of_q.size() < of_p.size();
  const VertexId other = fewer ? p : q;
  bool any = false;  // no branches: any may have changed, or be on the edge
  for (const ElementId before : fewer ? of_q : of_p) {
    if (before == element) break;
    bool on_edge = false;
    for (const VertexId v : mesh.corners_of[before]) on_edge |= v == other;
    any |= on_edge & (mesh.changed_at[before] > after);
  }
  return !any;
}

/// The edges no shorter than a limit, which is not below that of the survey, around which an
/// element changed after an epoch, each once; in an order that does not depend on threads. The
/// epoch is not later than when the survey was last used.
/// Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
runtime::UnsetVector<LongEdge> long_edges(const runtime::Executor& executor,
                                          const Mesh<Dim, Space>& mesh,
                                          EdgeSurvey<Dim, Space>& survey, double limit,
                                          std::uint32_t after) {
  survey.renew(executor, mesh, [&](ElementId e) { return mesh.changed_at[e] > after; });
  constexpr std::size_t stretch = EdgeSurvey<Dim, Space>::stretch;
  const auto find = [&](std::size_t i, auto&& append) {
    survey.visit_longer(mesh, i * stretch, [&](ElementId e, std::size_t k) {
      if (mesh.changed_at[e] <= after || !stands_for(mesh, e, k, after)) return;
      const auto [p, q] = ends_of_edge<Dim>(mesh.corners_of[e], k);
      const EndSquares squares = end_squares(mesh.site_of[p], mesh.site_of[q]);
      if (shorter_than(squares, limit)) return;
      const auto length = static_cast<float>(edge_length(squares));
      append(LongEdge{std::min(p, q), std::max(p, q), length});
    });
  };
  return runtime::parallel_collect<LongEdge>(executor,
                                             (mesh.element_slots() + stretch - 1) / stretch, find);
}

}  // namespace ductile::meshadapt
