/// @file
/// Swap: reconnects vertices where that raises the worst quality of the elements concerned. In 2D
/// it flips the edge between two triangles. In 3D it removes an edge, with the best triangulation
/// of the ring around it (3-2, 4-4 and so on up to seven elements, also on flat boundary), or
/// replaces the face between two tetrahedra by an edge (2-3); below a smooth patch it cuts poor
/// elements off (cut_off.hpp). It runs by reservations of elements, because few of all edges and
/// faces act (or by colours, see swap_by_vertex.hpp); lists of vertices are read where nobody
/// writes.
#pragma once

#include <array>
#include <span>
#include <stdexcept>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "operators/cavity.hpp"
#include "operators/edge_range.hpp"

namespace ductile::meshadapt {

/// An edge a-b to remove, or in 3D a face a-b-c to pierce; c is none for an edge.
struct Swappable {
  VertexId a, b, c = none;
  float worst = 0;  ///< worst quality around it when it was found; the worst goes first
  friend auto operator<=>(const Swappable&, const Swappable&) = default;
};

template <int Dim, int Space = Dim>
class Swap {
 public:
  // ---- What it works on ----
  using Item = Swappable;
  using Plan = Replacement<Dim>;
  static constexpr bool forgoes_wakes = true;  // the next sweep looks at what has changed

  Swap(const runtime::Executor& executor, Mesh<Dim, Space>& mesh, const EdgeRange& range = {})
      : executor_(executor), mesh_(mesh), range_(range) {}

  /// Edges and faces of elements changed after an epoch whose swap would be an improvement now,
  /// where the worst mean ratio is below a bound. Only such as are likely to be worth a swap are
  /// looked at: in 2D edges opposite to a wide angle, in 3D long edges and large faces. New edges
  /// are in the range, or closer to it than the one that goes.
  static runtime::UnsetVector<Swappable> improvements(const runtime::Executor& executor,
                                                      Mesh<Dim, Space>& mesh, std::uint32_t after,
                                                      double below, const EdgeRange& range = {});

  /// New elements are worth it if the worst of them is better than this.
  static double bar(double worst_before) { return worst_before * 1.02 + 1e-4; }

  // ---- Plan: the elements to come, if they are better than those to go. Reads only. Nobody else
  // touches the elements to go; the worst go first. ----
  bool plan(const Item& item, Plan& plan, auto& reach) const {
    const auto of_a = mesh_.elements_of.of(item.a), of_b = mesh_.elements_of.of(item.b);
    const bool fewer = of_b.size() < of_a.size();
    const VertexId other = fewer ? item.a : item.b, third = item.c == none ? other : item.c;
    Shell shell;
    for (const ElementId e : fewer ? of_b : of_a) {
      int found = 0;  // no branches: any corner may be the one
      for (const VertexId v : mesh_.corners_of[e])
        found |= static_cast<int>(v == other) | 2 * static_cast<int>(v == third);
      if (found != 3) continue;
      if (!reach(e)) return false;
      shell.push_back(e);
    }
    return decide(item, shell, plan);
  }
  /// For whoever has reached for the elements around the edge, or on both sides of the face.
  bool decide(const Item& item, const Shell& shell, Plan& plan) const;

  [[gnu::always_inline]] void prefetch(const Item& item, int stage) const {
    prefetch_shell(mesh_, item.a, item.b, stage);
  }
  std::size_t resource_count() const { return mesh_.element_slots(); }
  std::uint32_t priority(const Item& item) const {
    return static_cast<std::uint32_t>(0x1p24F * std::clamp(item.worst, 0.0F, 1.0F));
  }

  // ---- Apply: replace the elements, with new ones where they become more ----
  void apply(const Item&, const Plan& plan, auto& commit) {
    replace(mesh_, plan, SharedLists<Dim, Space>(mesh_), [&] { return commit.fresh(); });
  }
  std::array<std::uint32_t, 1> demand(const Plan& plan) const {
    const std::size_t gone = plan.old_elements.size(), come = plan.new_elements.size();
    return {static_cast<std::uint32_t>(come > gone ? come - gone : 0)};
  }
  std::array<std::size_t, 1> counts() const { return {mesh_.element_slots()}; }
  void grow(const std::array<std::size_t, 1>& room) {
    if (room[0] >= none)
      throw std::length_error("a mesh of more elements than 32-bit numbers can count");
    const std::size_t before = mesh_.element_slots();
    mesh_.grow(executor_, mesh_.vertex_slots(), room[0]);
    for (std::size_t e = before; e < room[0]; ++e) mesh_.corners_of[e].fill(none);
  }
  /// Elements beyond the count stay and count as removed.
  void renumber(std::size_t, std::span<const runtime::Renumbered> moved, std::size_t) {
    for (const auto& [from, to] : moved) move_element(mesh_, from, to);
  }

 private:
  const runtime::Executor& executor_;
  Mesh<Dim, Space>& mesh_;
  EdgeRange range_;
};

template <>
bool Swap<2>::decide(const Swappable& item, const Shell& shell, Plan& plan) const;
template <>
bool Swap<2, 3>::decide(const Swappable& item, const Shell& shell, Plan& plan) const;
template <>
bool Swap<3>::decide(const Swappable& item, const Shell& shell, Plan& plan) const;
template <>
runtime::UnsetVector<Swappable> Swap<2>::improvements(const runtime::Executor& executor,
                                                      Mesh<2>& mesh, std::uint32_t after,
                                                      double below, const EdgeRange& range);
template <>
runtime::UnsetVector<Swappable> Swap<2, 3>::improvements(const runtime::Executor& executor,
                                                         Mesh<2, 3>& mesh, std::uint32_t after,
                                                         double below, const EdgeRange& range);
template <>
runtime::UnsetVector<Swappable> Swap<3>::improvements(const runtime::Executor& executor,
                                                      Mesh<3>& mesh, std::uint32_t after,
                                                      double below, const EdgeRange& range);

}  // namespace ductile::meshadapt
