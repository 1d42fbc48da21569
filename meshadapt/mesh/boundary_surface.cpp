#include "mesh/boundary_surface.hpp"

#include <algorithm>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {

using Marks = runtime::UnsetVector<std::uint8_t>;  // [vertex]

namespace {

/// Marks the vertices of elements of more than one region.
template <int Dim>
void mark_between_regions(const runtime::Executor& executor, const AnyMesh& mesh,
                          std::span<const std::uint32_t> region_of, Marks& marked) {
  const auto& elements = elements_in<Dim>(mesh).vertices;
  auto lowest = runtime::make_filled<std::uint32_t>(executor, mesh.vertex_count(), none);
  runtime::parallel_for(executor, elements.size(), [&](std::size_t e) {
    for (const VertexId v : elements[e]) runtime::atomic_min(lowest[v], region_of[e]);
  });
  runtime::parallel_for(executor, elements.size(), [&](std::size_t e) {
    for (const VertexId v : elements[e])
      if (lowest[v] != region_of[e]) runtime::atomic_mark(marked[v]);
  });
}

/// Marks the vertices that a side may have.
template <int Dim>
Marks marked_vertices(const runtime::Executor& executor, const AnyMesh& mesh, BoundaryFrom from,
                      std::span<const std::uint32_t> region_of) {
  auto marked = runtime::make_filled<std::uint8_t>(executor, mesh.vertex_count(),
                                                   from == BoundaryFrom::elements ? 1 : 0);
  if (from == BoundaryFrom::elements) return marked;
  const auto& facets = facets_in<Dim>(mesh).vertices;
  runtime::parallel_for(executor, facets.size(), [&](std::size_t f) {
    for (const VertexId v : facets[f]) runtime::atomic_mark(marked[v]);
  });
  if (!region_of.empty()) mark_between_regions<Dim>(executor, mesh, region_of, marked);
  return marked;
}

}  // namespace

template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_of(const runtime::Executor& executor,
                                                 const AnyMesh& mesh, BoundaryFrom from,
                                                 std::span<const std::uint32_t> region_of) {
  return sides_among<Dim>(executor, mesh, marked_vertices<Dim>(executor, mesh, from, region_of),
                          region_of);
}

/// Facets between two elements of one region cancel each other in a sum of hashes at their lowest
/// corner, so that hardly any others are left to sort.
template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_among(const runtime::Executor& executor,
                                                    const AnyMesh& mesh, const Marks& marked,
                                                    std::span<const std::uint32_t> region_of) {
  using Side = BoundarySide<Dim>;
  const auto& elements = elements_in<Dim>(mesh).vertices;
  const auto each_side = [&](std::size_t e, auto&& visit) {
    const Corners<Dim>& corners = elements[e];
    int count = 0;
    for (const VertexId v : corners) count += marked[v];
    if (count < Dim) return;
    for (int i = 0; i <= Dim; ++i) {
      if (count - marked[corners[static_cast<std::size_t>(i)]] < Dim) continue;
      Side side{facet_of<Dim>(corners, i), region_of.empty() ? 0 : region_of[e]};
      std::sort(side.corners.begin(), side.corners.end());
      visit(side);
    }
  };
  auto hashes_at = runtime::make_filled<std::uint64_t>(executor, mesh.vertex_count(), 0);  // lowest
  runtime::parallel_for(executor, elements.size(), [&](std::size_t e) {
    each_side(e, [&](const Side& side) {
      std::uint64_t hash = side.region;
      for (const VertexId v : side.corners) hash = runtime::mix64(hash ^ v);
      runtime::atomic_flip(hashes_at[side.corners[0]], hash);
    });
  });
  auto all =
      runtime::parallel_collect<Side>(executor, elements.size(), [&](std::size_t e, auto&& append) {
        each_side(e, [&](const Side& side) {
          if (hashes_at[side.corners[0]] != 0) append(side);
        });
      });
  runtime::parallel_sort(executor, std::span(all));
  return runtime::parallel_collect<Side>(executor, all.size(), [&](std::size_t i, auto&& append) {
    if ((i == 0 || all[i - 1] != all[i]) && (i + 1 == all.size() || all[i + 1] != all[i]))
      append(all[i]);
  });
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

/// Two sides at a joint that no third has.
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

template runtime::UnsetVector<BoundarySide<2>> sides_of(const runtime::Executor&, const AnyMesh&,
                                                        BoundaryFrom,
                                                        std::span<const std::uint32_t>);
template runtime::UnsetVector<BoundarySide<3>> sides_of(const runtime::Executor&, const AnyMesh&,
                                                        BoundaryFrom,
                                                        std::span<const std::uint32_t>);
template runtime::UnsetVector<BoundarySide<2>> sides_among(const runtime::Executor&, const AnyMesh&,
                                                           const Marks&,
                                                           std::span<const std::uint32_t>);
template runtime::UnsetVector<BoundarySide<3>> sides_among(const runtime::Executor&, const AnyMesh&,
                                                           const Marks&,
                                                           std::span<const std::uint32_t>);
template class BoundarySurface<2>;
template class BoundarySurface<3>;

}  // namespace ductile::meshadapt
