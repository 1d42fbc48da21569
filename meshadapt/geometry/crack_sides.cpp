#include "geometry/crack_sides.hpp"

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
runtime::UnsetVector<Meeting> meetings_at_sides(const runtime::Executor& executor,
                                                const Mesh<Dim>& mesh,
                                                const std::vector<TaggedFacet<Dim>>& facets,
                                                const FacetSides<Dim>& sides) {
  return runtime::parallel_collect<Meeting>(
      executor, sides.size(), [&](std::size_t i, auto&& append) {
        if (!sides.begins_run(i)) return;
        const auto run = sides.run_at(i);
        for (const FacetSide& f : run)
          for (const FacetSide& g : run) {
            const PatchId p = facets[f.facet].patch, q = facets[g.facet].patch;
            if (p < q && (Dim == 2 || folds_back<Dim>(mesh, facets[f.facet].corners,
                                                      facets[g.facet].corners, f.key)))
              append({p, q, f.key});
          }
      });
}

// ---- Pairs that lie against each other in one plane ----

/// One corner of a boundary facet.
using Corner = std::uint64_t;  // vertex, and the number of the facet

runtime::UnsetVector<Corner> corners_of_boundary(const runtime::Executor& executor,
                                                 const std::vector<TaggedFacet<3>>& facets) {
  auto corners =
      runtime::parallel_collect<Corner>(executor, facets.size(), [&](std::size_t f, auto&& append) {
        if (facets[f].other != none) return;
        for (const VertexId v : facets[f].corners) append(Corner{v} << 32U | f);
      });
  runtime::parallel_sort(executor, std::span(corners));
  return corners;
}

runtime::UnsetVector<Meeting> meetings_against(const runtime::Executor& executor,
                                               const Mesh<3>& mesh,
                                               const std::vector<TaggedFacet<3>>& facets) {
  constexpr double opposite = -(1 - 1e-8);
  const auto corners = corners_of_boundary(executor, facets);
  const auto vertex = [&](std::size_t i) { return corners[i] >> 32U; };
  const auto facet = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
  auto outwards = runtime::make_unset_vector<Vector<3>>(executor, facets.size());  // of length 1
  runtime::parallel_for(executor, facets.size(), [&](std::size_t f) {
    const Corners<3>& corners_there = mesh.corners_of[facets[f].element];
    outwards[f] = unit(normal_of<3>(mesh, facet_of<3>(corners_there, facets[f].facet)));
  });
  return runtime::parallel_collect<Meeting>(
      executor, corners.size(), [&](std::size_t i, auto&& append) {
        for (std::size_t j = i + 1; j < corners.size() && vertex(j) == vertex(i); ++j) {
          const std::uint32_t f = facet(i), g = facet(j);
          const auto [p, q] = std::minmax(facets[f].patch, facets[g].patch);
          if (p != q && dot(outwards[f], outwards[g]) < opposite) append({p, q, vertex(i)});
        }
      });
}

}  // namespace

template <int Dim>
void mark_crack_sides(const runtime::Executor& executor, Mesh<Dim>& mesh,
                      const std::vector<TaggedFacet<Dim>>& facets, const FacetSides<Dim>& sides,
                      double straight) {
  mark_pairs(mesh, meetings_at_sides(executor, mesh, facets, sides),
             [&](std::span<const Meeting> rim) { return encloses(mesh, rim, straight); });
  if constexpr (Dim == 3)
    mark_pairs(mesh, meetings_against(executor, mesh, facets), [](std::span<const Meeting> shared) {
      return shared.front().key != shared.back().key;
    });
}

template void mark_crack_sides(const runtime::Executor&, Mesh<2>&,
                               const std::vector<TaggedFacet<2>>&, const FacetSides<2>&, double);
template void mark_crack_sides(const runtime::Executor&, Mesh<3>&,
                               const std::vector<TaggedFacet<3>>&, const FacetSides<3>&, double);

}  // namespace ductile::meshadapt
