/// @file
/// Counts of edges for the report of an adaptation: of those that are too long or too short because
/// required entities hold them, and of short ones on curved and on flat boundaries. They are
/// counted at the end, because kernels refuse one edge again and again, and for other reasons, too.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// Two sums that are counted together.
using Counts = std::array<std::size_t, 2>;

/// The sums of counts_of(i) over i below n.
Counts summed(const runtime::Executor& executor, std::size_t n, auto&& counts_of) {
  return runtime::parallel_reduce(executor, n, Counts{}, counts_of,
                                  [](const Counts& a, const Counts& b) {
                                    return Counts{a[0] + b[0], a[1] + b[1]};
                                  });
}

/// The share of edges that are longer than a limit, an edge counted once for each element around
/// it.
template <int Dim, int Space>
double share_of_long_edges(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                           double limit) {
  const auto [all, longer] = summed(executor, mesh.element_slots(), [&](std::size_t e) {
    Counts counts{};
    if (!mesh.alive(static_cast<ElementId>(e))) return counts;
    for (std::size_t k = 0; k < Simplex<Dim>::edges; ++k) {
      const auto [a, b] = ends_of_edge<Dim>(mesh.corners_of[e], k);
      ++counts[0];
      counts[1] += !shorter_than(mesh.site_of[a], mesh.site_of[b], limit);
    }
    return counts;
  });
  return static_cast<double>(longer) / static_cast<double>(std::max<std::size_t>(1, all));
}

/// The sums of counts_of(v, w) over edges: each_end(v, append) appends the other ends of those at
/// v, some of them several times.
template <int Dim, int Space>
Counts summed_over_edges(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                         auto&& each_end, auto&& counts_of) {
  runtime::PerThread<std::vector<VertexId>> buffers(executor);
  return summed(executor, mesh.vertex_slots(), [&](std::size_t at) {
    const auto v = static_cast<VertexId>(at);
    std::vector<VertexId>& ends = buffers.mine();
    ends.clear();
    each_end(v, [&](VertexId w) {
      if (w > v) ends.push_back(w);
    });
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    Counts sum{};
    for (const VertexId w : ends) {
      const Counts counts = counts_of(v, w);
      sum = {sum[0] + counts[0], sum[1] + counts[1]};
    }
    return sum;
  });
}

/// Which edges of a mesh required entities hold.
template <int Dim, int Space = Dim>
class HeldEdges {
 public:
  explicit HeldEdges(const Mesh<Dim, Space>& mesh) : mesh_(mesh) {}

  /// May there be any? Most meshes have no required entities.
  bool are_possible(const runtime::Executor& executor) const {
    const auto is_required = [](const auto& entity) { return entity.required; };
    return std::ranges::any_of(mesh_.patches, is_required) ||
           std::ranges::any_of(mesh_.curves, is_required) ||
           std::ranges::any_of(mesh_.regions, is_required) ||
           runtime::parallel_reduce(
               executor, mesh_.vertex_slots(), false,
               [&](std::size_t v) { return mesh_.kind_of[v].required; },
               [](bool a, bool b) { return a || b; });
  }

  /// Does an edge belong to a required entity, so that it may not be split?
  bool is_required(VertexId a, VertexId b) const {
    bool required = false;
    visit_shell(mesh_, a, b, [&](ElementId e) { required = required || is_required_in(e, a, b); });
    if constexpr (Dim == 3) required = required || mesh_.curves[mesh_.curve_of(a, b)].required;
    return required;
  }

  /// May neither end be moved onto the other, because of required entities?
  bool is_held(VertexId a, VertexId b) const {
    return (is_required(a) || is_required(b)) && !may_go(a, b) && !may_go(b, a);
  }

 private:
  /// Is `holds` true for the patch of one of an element's facets that have all these vertices?
  bool any_patch(ElementId e, auto&& holds, auto... vertices) const {
    for (std::size_t i = 0; i <= Dim; ++i)
      if (((mesh_.corners_of[e][i] != vertices) && ...) && holds(mesh_.patches_of[e][i]))
        return true;
    return false;
  }

  /// Is an element required, or one of those facets?
  bool is_required_in(ElementId e, auto... vertices) const {
    return mesh_.required_element(e) ||
           any_patch(
               e, [&](PatchId patch) { return mesh_.patches[patch].required; }, vertices...);
  }

  bool is_required(VertexId v) const {
    return mesh_.kind_of[v].required ||
           std::ranges::any_of(mesh_.elements_of.of(v),
                               [&](ElementId e) { return is_required_in(e, v); }) ||
           (Dim == 3 && std::ranges::any_of(mesh_.links_of.of(v), [&](const CurveLink& link) {
              return mesh_.curves[link.curve].required;
            }));
  }

  /// May a vertex be moved onto another, as far as required entities and the boundary, along which
  /// it stays, are concerned?
  bool may_go(VertexId gone, VertexId kept) const {
    const int class_dimension = mesh_.kind_of[gone].class_dimension;
    if (class_dimension == 0 || is_required(gone)) return false;
    if (class_dimension == Dim) return true;
    if (Dim == 3 && class_dimension == 1) return mesh_.curve_of(gone, kept) != 0;
    bool on_patch = false;
    visit_shell(mesh_, gone, kept, [&](ElementId e) {
      on_patch = on_patch || any_patch(
                                 e, [](PatchId patch) { return patch != 0; }, gone, kept);
    });
    return on_patch;
  }

  const Mesh<Dim, Space>& mesh_;
};

/// Is a facet on a smooth patch? Of a surface: does an edge belong to a triangle on one?
template <int Dim, int Space>
bool is_curved(const Mesh<Dim, Space>& mesh, ElementId e, [[maybe_unused]] std::size_t facet) {
  if constexpr (Dim < Space)
    return mesh.regions[mesh.region_of[e]].smooth;
  else
    return mesh.patches[mesh.patches_of[e][facet]].smooth;
}

/// Counts the edges of the report. Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
void count_edges(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                 const Rules& rules, AdaptReport& report) {
  const auto each_end = [&](VertexId v, auto&& append) {
    for (const ElementId e : mesh.elements_of.of(v))
      for (const VertexId w : mesh.corners_of[e]) append(w);
  };
  const auto each_end_on_curved = [&](VertexId v, auto&& append) {
    for (const ElementId e : mesh.elements_of.of(v))
      for (std::size_t i = 0; i <= Dim; ++i)
        if (is_curved(mesh, e, i) && mesh.corners_of[e][i] != v)
          for (const VertexId w : facet_of<Dim>(mesh.corners_of[e], static_cast<int>(i))) append(w);
  };
  if (mesh.surface) {
    const auto [all, shorter] =
        summed_over_edges(executor, mesh, each_end_on_curved, [&](VertexId v, VertexId w) {
          return Counts{1, std::size_t{mesh.length(v, w) < std::sqrt(0.5)}};
        });
    report.curved_edges = all;
    report.curved_edges_short = shorter;
  }
  const HeldEdges<Dim, Space> held(mesh);
  if (!held.are_possible(executor)) return;
  const auto [longer, shorter] =
      summed_over_edges(executor, mesh, each_end, [&](VertexId v, VertexId w) {
        const double length = mesh.length(v, w);
        return Counts{std::size_t{length > rules.long_edge && held.is_required(v, w)},
                      std::size_t{length < rules.short_edge && held.is_held(v, w)}};
      });
  report.held_long_edges = longer;
  report.held_short_edges = shorter;
}

/// Are many edges of facets between vertices that may not move too short? Thread safety: one
/// caller; runs on the executor.
template <int Dim, int Space>
bool has_short_facets(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                      const Rules& rules) {
  constexpr std::size_t least = 32, part = 10;
  const auto is_fixed = [&](VertexId v) { return mesh.kind_of[v].class_dimension == 0; };
  const auto counts_in = [&](std::size_t e) {
    Counts counts{};
    if (!mesh.alive(static_cast<ElementId>(e))) return counts;
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (Dim == Space && mesh.patches_of[e][i] == 0) continue;
      const Facet<Dim> facet = facet_of<Dim>(mesh.corners_of[e], static_cast<int>(i));
      for (std::size_t a = 0; a < Dim; ++a)
        for (std::size_t b = 0; b < a; ++b) {
          const VertexId v = facet[a], w = facet[b];
          ++counts[0];
          counts[1] += is_fixed(v) && is_fixed(w) && mesh.length(v, w) < rules.short_edge;
        }
    }
    return counts;
  };
  const auto [all, shorter] = summed(executor, mesh.element_slots(), counts_in);
  return shorter >= least && shorter * part >= all;
}

}  // namespace ductile::meshadapt
