/// @file
/// FacetSides: which boundary and interface facets meet where, by their sides: the vertices of an
/// edge in 2D, the edges of a triangle in 3D.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "geometry/classify.hpp"

namespace ductile::meshadapt {

/// The side that facets share: a vertex in 2D; in 3D the ends of an edge, the lower in the upper
/// half.
using SideKey = std::uint64_t;
inline SideKey edge_key(VertexId a, VertexId b) {
  return SideKey{std::min(a, b)} << 32U | std::max(a, b);
}

/// The ends of an edge in 3D, the lower first.
inline std::array<VertexId, 2> ends_of(SideKey key) {
  return {static_cast<VertexId>(key >> 32U), static_cast<VertexId>(key)};
}

template <int Dim, class Visit>
void each_side(const Facet<Dim>& facet, Visit visit) {
  if constexpr (Dim == 2) {
    visit(SideKey{facet[0]});
    visit(SideKey{facet[1]});
  } else {
    for (std::size_t i = 0; i < 3; ++i) visit(edge_key(facet[i], facet[(i + 1) % 3]));
  }
}

/// One facet's side.
struct FacetSide {
  SideKey key;
  std::uint32_t facet;
  std::uint8_t number;  // among the facet's
  auto operator<=>(const FacetSide&) const = default;
};

/// The sides of facets, sorted.
template <int Dim>
class FacetSides {
 public:
  /// corners_of(facet) gives the corners.
  FacetSides(const runtime::Executor& executor, std::size_t facet_count, auto&& corners_of)
      : sides_(runtime::make_unset_vector<FacetSide>(executor, Dim * facet_count)) {
    runtime::parallel_for(executor, facet_count, [&](std::size_t f) {
      std::uint8_t number = 0;
      each_side<Dim>(corners_of(f), [&](SideKey key) {
        sides_[Dim * f + number] = {key, static_cast<std::uint32_t>(f), number};
        ++number;
      });
    });
    runtime::parallel_sort(executor, std::span(sides_));
  }

  std::size_t size() const { return sides_.size(); }
  auto begin() const { return sides_.begin(); }
  auto end() const { return sides_.end(); }

  /// The facets at a side that begins here, in order.
  std::span<const FacetSide> run_at(std::size_t begin) const {
    std::size_t end = begin + 1;
    while (end < sides_.size() && sides_[end].key == sides_[begin].key) ++end;
    return std::span(sides_).subspan(begin, end - begin);
  }
  bool begins_run(std::size_t i) const { return i == 0 || sides_[i - 1].key != sides_[i].key; }
  /// Calls visit(facets at the side) for each side.
  void each_run(auto&& visit) const {
    for (std::size_t i = 0; i < sides_.size();) {
      const auto run = run_at(i);
      visit(run);
      i += run.size();
    }
  }

  std::span<const FacetSide> at(SideKey key) const {
    const auto at = std::lower_bound(sides_.begin(), sides_.end(), FacetSide{key, 0, 0});
    if (at == sides_.end() || at->key != key) return {};
    return run_at(static_cast<std::size_t>(at - sides_.begin()));
  }

 private:
  runtime::UnsetVector<FacetSide> sides_;
};

/// Do two triangles pass a side that they share in the same direction, so that one is turned over
/// against the other?
inline bool are_opposite(const std::vector<Corners<2>>& triangles, const FacetSide& side,
                         const FacetSide& other) {
  return triangles[side.facet][side.number] == triangles[other.facet][other.number];
}

/// The sides of two triangles that are turned in opposite ways.
inline std::vector<SideKey> seams_of(const FacetSides<3>& sides,
                                     const std::vector<Corners<2>>& triangles) {
  std::vector<SideKey> seams;
  sides.each_run([&](std::span<const FacetSide> run) {
    if (run.size() == 2 && are_opposite(triangles, run[0], run[1])) seams.push_back(run[0].key);
  });
  return seams;
}

/// Normal of a facet; its length is the edge's length in 2D, twice the area in 3D.
template <int Dim>
Vector<Dim> normal_of(const Mesh<Dim>& mesh, const Facet<Dim>& facet) {
  std::array<Vector<Dim>, Dim> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = mesh.site_of[facet[i]].position;
  return facet_normal(p);
}

/// From a side of a facet into the facet, at a right angle.
template <int Dim>
Vector<Dim> away_from(const Mesh<Dim>& mesh, const Facet<Dim>& facet, SideKey key) {
  const auto at = [&](VertexId v) { return mesh.site_of[v].position; };
  if constexpr (Dim == 2) {
    const auto shared = static_cast<VertexId>(key);
    return at(facet[0] == shared ? facet[1] : facet[0]) - at(shared);
  } else {
    const auto [a, b] = ends_of(key);
    VertexId third = facet[0];
    for (const VertexId v : facet)
      if (v != a && v != b) third = v;
    const Vector<3> side = at(b) - at(a), inwards = at(third) - at(a);
    return inwards - (dot(inwards, side) / dot(side, side)) * side;
  }
}

/// Do two facets of one plane lie on the same side of what they share? So it is at the tip of a
/// slit, where the boundary turns back.
template <int Dim>
bool folds_back(const Mesh<Dim>& mesh, const Facet<Dim>& f, const Facet<Dim>& g, SideKey key) {
  return dot(away_from<Dim>(mesh, f, key), away_from<Dim>(mesh, g, key)) > 0;
}

/// The corners of a facet, seen from outside its element.
template <int Dim>
Facet<Dim> outward_corners(const Mesh<Dim>& mesh, const TaggedFacet<Dim>& facet) {
  return facet_of<Dim>(mesh.corners_of[facet.element], facet.facet);
}

/// Are the elements of two facets, which have a side in common, on the same side of them?
template <int Dim>
bool face_alike(const Mesh<Dim>& mesh, const TaggedFacet<Dim>& f, const TaggedFacet<Dim>& g) {
  const Facet<Dim> p = outward_corners(mesh, f), q = outward_corners(mesh, g);
  for (std::size_t i = 0; i < Dim; ++i) {
    const int at = corner_of(q, p[i]);
    if (at < 0) continue;
    if constexpr (Dim == 2) return static_cast<std::size_t>(at) != i;
    const VertexId next = p[(i + 1) % Dim];
    if (contains(q, next)) return q[(static_cast<std::size_t>(at) + 1) % Dim] != next;
  }
  return true;
}

/// How many triangles follow each other around a vertex, from one and away from a side of it, up to
/// a curve, or where not two triangles have a side, or to the first again. Needs no kinds of
/// vertices, so that kinds can be found with it, by many threads.
inline std::size_t facets_around(const Mesh<3>& mesh, const std::vector<TaggedFacet<3>>& facets,
                                 const FacetSides<3>& sides, VertexId vertex,
                                 const FacetSide& first) {
  const auto is_on_curve = [&](VertexId other) {
    return std::ranges::any_of(mesh.links_of.of(vertex),
                               [&](const CurveLink& link) { return link.to == other; });
  };
  std::size_t count = 0;
  std::uint32_t at = first.facet;
  SideKey from = first.key;
  do {
    ++count;
    VertexId next = none;  // the triangle's corner on its other side at the vertex
    for (const VertexId v : facets[at].corners)
      if (v != vertex && edge_key(vertex, v) != from) next = v;
    from = edge_key(vertex, next);
    const auto both = sides.at(from);
    if (both.size() != 2 || is_on_curve(next)) break;
    at = both[0].facet == at ? both[1].facet : both[0].facet;
  } while (at != first.facet);
  return count;
}

}  // namespace ductile::meshadapt
