#include "mesh/boundary_surface.hpp"

#include <algorithm>
#include <utility>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {

template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_of(const runtime::Executor& executor,
                                                 const Adjacency<Dim>& adjacency,
                                                 std::span<const std::uint32_t> region_of) {
  auto sides = runtime::parallel_collect<BoundarySide<Dim>>(
      executor, adjacency.corners_of.size(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        for (int i = 0; i <= Dim; ++i) {
          if (!adjacency.on_region_boundary(element, i, region_of)) continue;
          Facet<Dim> corners = facet_of<Dim>(adjacency.corners_of[e], i);
          std::sort(corners.begin(), corners.end());
          append({corners, region_of.empty() ? 0 : region_of[e]});
        }
      });
  runtime::parallel_sort(executor, std::span(sides));
  return sides;
}

template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_in(const AdjacentMesh& mesh,
                                                 std::span<const std::uint32_t> region_of) {
  if (Dim == 2 || !is_surface(mesh.mesh()))
    return sides_of<Dim>(mesh.executor(), mesh.adjacency<Dim>(), region_of);
  const auto& triangles = facets_in<Dim>(mesh.mesh()).vertices;
  auto sides = runtime::make_unset_vector<BoundarySide<Dim>>(mesh.executor(), triangles.size());
  runtime::parallel_for(mesh.executor(), sides.size(), [&](std::size_t t) {
    sides[t] = {triangles[t], region_of.empty() ? 0 : region_of[t]};
    std::sort(sides[t].corners.begin(), sides[t].corners.end());
  });
  runtime::parallel_sort(mesh.executor(), std::span(sides));
  return sides;
}

template <int Dim>
BoundarySurface<Dim>::BoundarySurface(const runtime::Executor& executor,
                                      runtime::UnsetVector<BoundarySide<Dim>> sides)
    : sides_(std::move(sides)),
      parts_(executor, 0),
      sheets_(executor, sides_.size()),
      fans_(executor, Dim * sides_.size()) {
  find_vertices(executor);
  find_joints(executor);
  parts_ = runtime::DisjointSets(executor, vertices_.size());
  connect(executor);
}

template <int Dim>
void BoundarySurface<Dim>::find_vertices(const runtime::Executor& executor) {
  auto all = runtime::make_unset_vector<Vertex>(executor, Dim * sides_.size());
  runtime::parallel_for(executor, sides_.size(), [&](std::size_t s) {
    for (std::size_t i = 0; i < Dim; ++i)
      all[Dim * s + i] = Vertex{sides_[s].corners[i]} << 32U | sides_[s].region;
  });
  runtime::parallel_sort(executor, std::span(all));
  vertices_ =
      runtime::parallel_collect<Vertex>(executor, all.size(), [&](std::size_t i, auto&& append) {
        if (i == 0 || all[i - 1] != all[i]) append(all[i]);
      });
}

template <int Dim>
void BoundarySurface<Dim>::find_joints(const runtime::Executor& executor) {
  joints_ = runtime::make_unset_vector<BoundaryJoint>(executor, Dim * sides_.size());
  runtime::parallel_for(executor, sides_.size(), [&](std::size_t s) {
    const auto& [corners, region] = sides_[s];
    for (std::size_t i = 0; i < Dim; ++i) {
      std::uint64_t key = 0;
      for (std::size_t k = 0; k < Dim; ++k)
        if (k != i) key = key << 32U | corners[k];
      joints_[Dim * s + i] = {key, region, static_cast<std::uint32_t>(s),
                              static_cast<std::uint32_t>(i)};
    }
  });
  runtime::parallel_sort(executor, std::span(joints_));
}

template <int Dim>
void BoundarySurface<Dim>::connect(const runtime::Executor& executor) {
  runtime::parallel_for(executor, sides_.size(), [&](std::size_t s) {
    const auto first = static_cast<std::uint32_t>(index_of(sides_[s], 0));
    for (std::size_t i = 1; i < Dim; ++i)
      parts_.unite(first, static_cast<std::uint32_t>(index_of(sides_[s], i)));
  });
  runtime::parallel_for(executor, joints_.size(), [&](std::size_t j) {
    if ((j == 0 || !joints_[j - 1].is_at(joints_[j])) && end_of_run(j) - j == 2)
      connect(joints_[j], joints_[j + 1]);
  });
}

/// Connects the two sides at a joint that no third has.
template <int Dim>
void BoundarySurface<Dim>::connect(const BoundaryJoint& one, const BoundaryJoint& other) {
  sheets_.unite(one.side, other.side);
  // Corners are ascending, so the joint's come in the same order on both sides.
  for (std::uint32_t i = 0, k = 0; i < Dim; ++i, ++k) {
    if (i == one.number) ++i;
    if (k == other.number) ++k;
    if (i < Dim) fans_.unite(Dim * one.side + i, Dim * other.side + k);
  }
}

template <int Dim>
std::size_t BoundarySurface<Dim>::index_of(const BoundarySide<Dim>& side,
                                           std::size_t corner) const {
  const Vertex vertex = Vertex{side.corners[corner]} << 32U | side.region;
  return static_cast<std::size_t>(std::lower_bound(vertices_.begin(), vertices_.end(), vertex) -
                                  vertices_.begin());
}

template runtime::UnsetVector<BoundarySide<2>> sides_of(const runtime::Executor&,
                                                        const Adjacency<2>&,
                                                        std::span<const std::uint32_t>);
template runtime::UnsetVector<BoundarySide<3>> sides_of(const runtime::Executor&,
                                                        const Adjacency<3>&,
                                                        std::span<const std::uint32_t>);
template runtime::UnsetVector<BoundarySide<2>> sides_in<2>(const AdjacentMesh&,
                                                           std::span<const std::uint32_t>);
template runtime::UnsetVector<BoundarySide<3>> sides_in<3>(const AdjacentMesh&,
                                                           std::span<const std::uint32_t>);
template class BoundarySurface<2>;
template class BoundarySurface<3>;

}  // namespace ductile::meshadapt
