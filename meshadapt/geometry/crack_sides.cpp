#include "geometry/boundary_parts.hpp"

#include <algorithm>
#include <compare>
#include <span>

#include "core/unit.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {

namespace {

/// Two patches have a side in common, or in 3D a vertex.
struct Meeting {
  PatchId p, q;  // p < q
  SideKey key;
  auto operator<=>(const Meeting&) const = default;
};

/// Calls visit(meetings) for each pair of patches, and marks the pair if that says yes.
template <int Dim, class Visit>
void mark_pairs(Mesh<Dim>& mesh, runtime::UnsetVector<Meeting> meetings, Visit visit) {
  std::sort(meetings.begin(), meetings.end());
  for (std::size_t begin = 0, end = 0; begin < meetings.size(); begin = end) {
    const auto [p, q, key] = meetings[begin];
    while (end < meetings.size() && meetings[end].p == p && meetings[end].q == q) ++end;
    if (visit(std::span(meetings).subspan(begin, end - begin)))
      mesh.patches[p].crack_side = mesh.patches[q].crack_side = true;
  }
}

// ---- Pairs with a rim in common ----

/// Is there room between what two patches have in common: is that more than a point, or a line?
template <int Dim>
bool encloses(const Mesh<Dim>& mesh, std::span<const Meeting> rim, double tolerance) {
  if constexpr (Dim == 2) return rim.front().key != rim.back().key;
  const auto at = [&](SideKey key) { return mesh.site_of[static_cast<VertexId>(key)].position; };
  const Vector<Dim> origin = at(rim.front().key);
  Vector<Dim> farthest{};
  const auto each_vertex = [&](auto&& visit) {
    for (const Meeting& meeting : rim)
      for (const SideKey v : {meeting.key >> 32U, meeting.key & 0xffffffffU}) visit(at(v) - origin);
  };
  each_vertex([&](const Vector<Dim>& d) {
    if (dot(d, d) > dot(farthest, farthest)) farthest = d;
  });
  bool straight = true;
  const double square = dot(farthest, farthest);
  each_vertex([&](const Vector<Dim>& d) {
    straight = straight && norm(d - (dot(d, farthest) / square) * farthest) <= tolerance;
  });
  return !straight;
}

template <int Dim>
runtime::UnsetVector<Meeting> meetings_at_sides(const BoundaryParts<Dim>& parts) {
  return runtime::parallel_collect<Meeting>(
      parts.executor, parts.sides.size(), [&](std::size_t i, auto&& append) {
        if (!parts.sides.begins_run(i)) return;
        const auto run = parts.sides.run_at(i);
        for (const FacetSide& side : run)
          for (const FacetSide& other : run) {
            const auto &f = parts.facets[side.facet], &g = parts.facets[other.facet];
            if (f.patch < g.patch &&
                (Dim == 2 || folds_back<Dim>(parts.mesh, f.corners, g.corners, side.key)))
              append({f.patch, g.patch, side.key});
          }
      });
}

// ---- Pairs that lie against each other in one plane ----

/// One corner of a boundary facet.
using Corner = std::uint64_t;  // vertex, and the number of the facet

runtime::UnsetVector<Corner> corners_of_boundary(const BoundaryParts<3>& parts) {
  auto corners = runtime::parallel_collect<Corner>(
      parts.executor, parts.facets.size(), [&](std::size_t f, auto&& append) {
        if (parts.facets[f].other != none) return;
        for (const VertexId v : parts.facets[f].corners) append(Corner{v} << 32U | f);
      });
  runtime::parallel_sort(parts.executor, std::span(corners));
  return corners;
}

runtime::UnsetVector<Meeting> meetings_against(const BoundaryParts<3>& parts) {
  constexpr double opposite = -(1 - 1e-8);
  const auto& facets = parts.facets;
  const auto corners = corners_of_boundary(parts);
  const auto vertex = [&](std::size_t i) { return corners[i] >> 32U; };
  const auto facet = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
  auto outwards = runtime::make_unset_vector<Vector<3>>(parts.executor, facets.size());
  runtime::parallel_for(parts.executor, facets.size(), [&](std::size_t f) {
    outwards[f] = unit(normal_of<3>(parts.mesh, outward_corners(parts.mesh, facets[f])));
  });
  return runtime::parallel_collect<Meeting>(
      parts.executor, corners.size(), [&](std::size_t i, auto&& append) {
        for (std::size_t j = i + 1; j < corners.size() && vertex(j) == vertex(i); ++j) {
          const std::uint32_t f = facet(i), g = facet(j);
          const auto [p, q] = std::minmax(facets[f].patch, facets[g].patch);
          if (p != q && dot(outwards[f], outwards[g]) < opposite) append({p, q, vertex(i)});
        }
      });
}

}  // namespace

template <int Dim>
void mark_crack_sides(BoundaryParts<Dim>& parts) {
  const double straight = parts.is_rough() ? parts.rounding->tolerance : parts.within.flat;
  mark_pairs(parts.mesh, meetings_at_sides(parts),
             [&](std::span<const Meeting> rim) { return encloses(parts.mesh, rim, straight); });
  if constexpr (Dim == 3)
    mark_pairs(parts.mesh, meetings_against(parts), [](std::span<const Meeting> shared) {
      return shared.front().key != shared.back().key;
    });
}

template void mark_crack_sides(BoundaryParts<2>&);
template void mark_crack_sides(BoundaryParts<3>&);

}  // namespace ductile::meshadapt
