/// @file
/// SwapByVertex: the swaps of Swap as an operator on vertices, to be run by colours with deferred
/// changes of lists, as published (Rokos, Gorman, Jensen, Kelly, arXiv:1505.04694, 2015): a vertex
/// has the elements around it to itself while its class runs, and swaps the edges and faces of
/// which it has the lowest number, one each time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/cavity.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
class SwapByVertex {
 public:
  // ---- What it works on ----
  using Item = VertexId;
  using Plan = Replacement<Dim>;
  static constexpr bool forgoes_wakes = true;  // the next sweep looks at what has changed

  /// Takes what Swap::improvements() has found. Runs on the executor.
  SwapByVertex(const runtime::Executor& executor, Mesh<Dim, Space>& mesh,
               runtime::UnsetVector<Swappable> found, const EdgeRange& range = {})
      : executor_(executor),
        mesh_(mesh),
        swap_(executor, mesh, range),
        found_(std::move(found)),
        deferred_(executor) {
    parallel_sort(executor, std::span(found_));
  }

  /// The work: those of lowest number of all that was found.
  runtime::UnsetVector<VertexId> vertices() const {
    return runtime::parallel_collect<VertexId>(executor_, found_.size(),
                                               [&](std::size_t i, auto&& append) {
                                                 if (i == 0 || found_[i].a != found_[i - 1].a)
                                                   append(found_[i].a);
                                               });
  }

  // ---- Plan: the first swap of the vertex's that is an improvement. Reads only; what it reads of
  // the lists of others nobody writes, because a class is planned before any of it is applied ----
  bool plan(VertexId vertex, Plan& plan, auto& reach) const {
    if (!reach_ball(mesh_, vertex, reach)) return false;
    const auto found = found_at(vertex);
    return std::any_of(found.begin(), found.end(), [&](const Swappable& item) {
      return swap_.decide(item, shell_at(item), plan);
    });
  }

  // ---- Conflict rule: adjacent vertices share elements ----
  void conflicts(VertexId vertex, auto&& visit) const { visit_neighbours(mesh_, vertex, visit); }
  std::size_t resource_count() const { return mesh_.vertex_slots(); }

  // ---- Apply: replace the elements, defer the changes of lists. Of two vertices that have become
  // neighbours one is postponed ----
  void apply(VertexId vertex, const Plan& plan, auto& commit) {
    visit_new_edges(plan, [&](VertexId a, VertexId b) {
      if (!found_at(a).empty() && !found_at(b).empty()) commit.postpone(std::max(a, b));
    });
    replace(mesh_, plan, SharedLists<Dim, Space>(mesh_, &deferred_),
            [&] { return commit.fresh(1); });
    if (found_at(vertex).size() > 1) commit.wake(vertex);
  }
  std::size_t commit() { return commit_lists(mesh_, deferred_); }

  // ---- What is made: no vertices, and elements ----
  std::array<std::uint32_t, 2> demand(const Plan& plan) const { return {0, swap_.demand(plan)[0]}; }
  std::array<std::size_t, 2> counts() const {
    return {mesh_.vertex_slots(), mesh_.element_slots()};
  }
  void grow(const std::array<std::size_t, 2>& room) { swap_.grow({room[1]}); }
  void renumber(std::size_t kind, std::span<const runtime::Renumbered> moved, std::size_t count) {
    if (kind == 1) swap_.renumber(0, moved, count);
  }

 private:
  /// The found swaps whose lowest vertex is this one.
  std::span<const Swappable> found_at(VertexId vertex) const {
    const auto [begin, end] = std::equal_range(
        found_.begin(), found_.end(), Swappable{vertex, 0},
        [](const Swappable& one, const Swappable& other) { return one.a < other.a; });
    return {begin, end};
  }

  /// The elements around the edge, or on both sides of the face.
  Shell shell_at(const Swappable& item) const {
    Shell shell;
    for (const ElementId e : mesh_.elements_of.of(item.a)) {
      const Corners<Dim>& corners = mesh_.corners_of[e];
      if (contains(corners, item.b) && (item.c == none || contains(corners, item.c)))
        shell.push_back(e);
    }
    return shell;
  }

  /// Visits the edges of the new elements that no removed element has.
  void visit_new_edges(const Plan& plan, auto&& visit) const {
    for (const Corners<Dim>& corners : plan.new_elements)
      for (std::size_t k = 0; k < Simplex<Dim>::edges; ++k) {
        const auto [a, b] = ends_of_edge<Dim>(corners, k);
        const auto has_edge = [&, a = a, b = b](ElementId e) {
          return contains(mesh_.corners_of[e], a) && contains(mesh_.corners_of[e], b);
        };
        if (std::none_of(plan.old_elements.begin(), plan.old_elements.end(), has_edge)) visit(a, b);
      }
  }

  const runtime::Executor& executor_;
  Mesh<Dim, Space>& mesh_;
  Swap<Dim, Space> swap_;
  runtime::UnsetVector<Swappable> found_;  // by vertex
  DeferredLists deferred_;
};

}  // namespace ductile::meshadapt
