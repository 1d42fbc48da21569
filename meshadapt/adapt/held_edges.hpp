/// @file
/// Edges of an adapted mesh that are too long or too short because required entities hold them.
/// Counted when all is done: kernels refuse one edge again and again, and for other reasons, too.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
class HeldEdges {
 public:
  struct Count {
    std::size_t longer = 0, shorter = 0;
    friend Count operator+(const Count& a, const Count& b) {
      return {a.longer + b.longer, a.shorter + b.shorter};
    }
  };

  /// Refers to both.
  HeldEdges(const Mesh<Dim>& mesh, const Rules& rules) : mesh_(mesh), rules_(rules) {}

  /// Whether there may be any: most meshes have no required entities.
  bool are_possible(const runtime::Executor& executor) const {
    const auto is_required = [](const auto& what) { return what.required; };
    return std::ranges::any_of(mesh_.patches, is_required) ||
           std::ranges::any_of(mesh_.curves, is_required) ||
           std::ranges::any_of(mesh_.regions, is_required) ||
           runtime::parallel_reduce(
               executor, mesh_.vertex_slots(), false,
               [&](std::size_t v) { return mesh_.kind_of[v].required; },
               [](bool a, bool b) { return a || b; });
  }

  /// Of the edges from v to vertices of higher numbers. `ends` is a buffer.
  Count count_at(VertexId v, std::vector<VertexId>& ends) const {
    ends.clear();
    for (const ElementId e : mesh_.elements_of.of(v))
      for (const VertexId w : mesh_.corners_of[e])
        if (w > v) ends.push_back(w);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    Count count;
    for (const VertexId w : ends) {
      const double length = mesh_.length(v, w);
      if (length > rules_.long_edge && is_required(v, w)) ++count.longer;
      if (length < rules_.short_edge && is_held(v, w)) ++count.shorter;
    }
    return count;
  }

 private:
  /// Calls visit(patch) for the patches of an element's facets that have all these vertices.
  void each_patch(ElementId e, auto&& visit, auto... vertices) const {
    for (std::size_t i = 0; i <= Dim; ++i)
      if (((mesh_.corners_of[e][i] != vertices) && ...)) visit(mesh_.patches_of[e][i]);
  }

  /// Does a vertex belong to a required entity?
  bool is_required(VertexId v) const {
    bool required = mesh_.kind_of[v].required;
    for (const ElementId e : mesh_.elements_of.of(v)) {
      required = required || mesh_.required_element(e);
      each_patch(
          e, [&](PatchId patch) { required = required || mesh_.patches[patch].required; }, v);
    }
    if constexpr (Dim == 3)
      for (const CurveLink& link : mesh_.links_of.of(v))
        required = required || mesh_.curves[link.curve].required;
    return required;
  }

  /// The same of the edge between two.
  bool is_required(VertexId a, VertexId b) const {
    bool required = false;
    visit_shell(mesh_, a, b, [&](ElementId e) {
      required = required || mesh_.required_element(e);
      each_patch(
          e, [&](PatchId patch) { required = required || mesh_.patches[patch].required; }, a, b);
    });
    if constexpr (Dim == 3) required = required || mesh_.curves[mesh_.curve_of(a, b)].required;
    return required;
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
      each_patch(
          e, [&](PatchId patch) { on_patch = on_patch || patch != 0; }, gone, kept);
    });
    return on_patch;
  }

  bool is_held(VertexId a, VertexId b) const {
    return (is_required(a) || is_required(b)) && !may_go(a, b) && !may_go(b, a);
  }

  const Mesh<Dim>& mesh_;
  const Rules& rules_;
};

/// Thread safety: one caller; runs on the executor.
template <int Dim>
void count_held_edges(const runtime::Executor& executor, const Mesh<Dim>& mesh, const Rules& rules,
                      AdaptReport& report) {
  using Count = typename HeldEdges<Dim>::Count;
  const HeldEdges<Dim> held(mesh, rules);
  if (!held.are_possible(executor)) return;
  runtime::PerThread<std::vector<VertexId>> ends(executor);
  const Count total = runtime::parallel_reduce(
      executor, mesh.vertex_slots(), Count{},
      [&](std::size_t v) { return held.count_at(static_cast<VertexId>(v), ends.mine()); },
      [](const Count& a, const Count& b) { return a + b; });
  report.held_long_edges = total.longer;
  report.held_short_edges = total.shorter;
}

/// Are many edges of facets shorter than asked for between vertices that may not move? Thread
/// safety: one caller; runs on the executor.
template <int Dim>
bool has_short_facets(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                      const Rules& rules) {
  constexpr std::size_t least = 32, part = 10;
  using Count = std::array<std::size_t, 2>;  // of sides, and of those that are short
  const auto count_in = [&](std::size_t at) {
    const auto e = static_cast<ElementId>(at);
    Count count{};
    if (!mesh.alive(e)) return count;
    for (int i = 0; i <= Dim; ++i) {
      if (mesh.patches_of[e][static_cast<std::size_t>(i)] == 0) continue;
      const Facet<Dim> facet = facet_of<Dim>(mesh.corners_of[e], i);
      for (std::size_t a = 0; a < Dim; ++a)
        for (std::size_t b = 0; b < a; ++b) {
          const VertexId v = facet[a], w = facet[b];
          ++count[0];
          count[1] += mesh.kind_of[v].class_dimension == 0 &&
                      mesh.kind_of[w].class_dimension == 0 && mesh.length(v, w) < rules.short_edge;
        }
    }
    return count;
  };
  const auto [all, shorter] = runtime::parallel_reduce(
      executor, mesh.element_slots(), Count{}, count_in, [](const Count& a, const Count& b) {
        return Count{a[0] + b[0], a[1] + b[1]};
      });
  return shorter >= least && shorter * part >= all;
}

}  // namespace ductile::meshadapt
