#include "geometry/damage.hpp"

#include <algorithm>
#include <map>
#include <span>

#include "ductile/runtime/worklist.hpp"
#include "geometry/crossing_facets.hpp"
#include "mesh/boundary_surface.hpp"

namespace ductile::meshadapt {

namespace {

using runtime::Executor;

template <int Dim>
Box<Dim> box_of(const AnyMesh& mesh, const Facet<Dim>& facet) {
  return box_around(points_in<Dim>(mesh, facet));
}

template <int Dim>
Facet<Dim> in_order(Facet<Dim> facet) {
  std::sort(facet.begin(), facet.end());
  return facet;
}

/// Adds the places where facets cross; nothing if those of `before` did.
template <int Dim>
void find_crossings(const Executor& executor, const AnyMesh& before, const AnyMesh& after,
                    std::vector<Box<Dim>>& places) {
  const auto crossings = [&](const AnyMesh& mesh) {
    const CrossingFacets<Dim> crossing(executor, mesh);
    return runtime::parallel_collect<Box<Dim>>(
        executor, crossing.size(), [&](std::size_t f, auto&& append) {
          const std::size_t g = crossing.partner_of(f);
          const auto& facets = facets_in<Dim>(mesh).vertices;
          if (g != no_index)
            append(join(box_of<Dim>(mesh, facets[f]), box_of<Dim>(mesh, facets[g])));
        });
  };
  const auto found = crossings(after);
  if (!found.empty() && crossings(before).empty())
    places.insert(places.end(), found.begin(), found.end());
}

/// Adds the places where a boundary meets itself.
template <int Dim>
void find_non_manifold(const AnyMesh& mesh, BoundarySurface<Dim>& surface,
                       std::vector<Box<Dim>>& places) {
  const auto add = [&](std::size_t side) {
    places.push_back(box_of<Dim>(mesh, surface.side(side).corners));
  };
  surface.each_meeting([&](std::span<const BoundaryJoint> joints) {
    if (joints.size() <= 2) return;
    for (const BoundaryJoint& joint : joints) add(joint.side);
  });
  std::vector<std::uint32_t> fan_at(mesh.vertex_count(), none);
  for (std::size_t s = 0; s < surface.size(); ++s)
    for (std::size_t i = 0; i < Dim; ++i) {
      std::uint32_t& fan = fan_at[surface.side(s).corners[i]];
      const std::uint32_t here = surface.fan_of_corner(Dim * s + i);
      if (fan == none) fan = here;
      if (fan == here) continue;
      add(s);
      add(fan / Dim);
    }
}

/// Adds the places of listed facets that are not on the boundary although none were before: their
/// sides met.
template <int Dim>
void find_inner_facets(const AnyMesh& before, const AnyMesh& after,
                       const BoundarySurface<Dim>& surface, std::vector<Box<Dim>>& places) {
  const auto& elements = elements_in<Dim>(before);
  const auto is_other = [&](std::int32_t r) { return r != elements.reference[0]; };
  // Interfaces are listed as well, so that only in one region it can be told.
  if (std::any_of(elements.reference.begin(), elements.reference.end(), is_other)) return;
  std::vector<Facet<Dim>> sides;
  for (std::size_t s = 0; s < surface.size(); ++s) sides.push_back(surface.side(s).corners);
  for (const Facet<Dim>& facet : facets_in<Dim>(after).vertices)
    if (!std::binary_search(sides.begin(), sides.end(), in_order<Dim>(facet)))
      places.push_back(box_of<Dim>(after, facet));
}

/// A part of the boundary: where it is, and its Euler characteristic.
template <int Dim>
struct BoundaryPart {
  Box<Dim> box = Box<Dim>::empty();
  long euler = 0;
};

template <int Dim>
std::vector<BoundaryPart<Dim>> parts_of(const AnyMesh& mesh, BoundarySurface<Dim>& surface) {
  std::map<std::uint32_t, BoundaryPart<Dim>> part;  // by its lowest vertex
  for (std::size_t v = 0; v < surface.vertex_count(); ++v) ++part[surface.part_of_vertex(v)].euler;
  for (std::size_t s = 0; s < surface.size(); ++s) {
    BoundaryPart<Dim>& here = part[surface.part_of_side(s)];
    here.box = join(here.box, box_of<Dim>(mesh, surface.side(s).corners));
    here.euler += Dim == 2 ? -1 : 1;
  }
  if constexpr (Dim == 3)
    surface.each_meeting([&](std::span<const BoundaryJoint> joints) {
      --part[surface.part_of_side(joints[0].side)].euler;
    });
  std::vector<BoundaryPart<Dim>> parts;
  parts.reserve(part.size());
  for (const auto& [vertex, each] : part) parts.push_back(each);
  return parts;
}

/// The most by which boxes differ anywhere.
template <int Dim>
double difference(const Box<Dim>& a, const Box<Dim>& b) {
  double most = 0;
  for (int i = 0; i < Dim; ++i)
    most = std::max({most, std::abs(a.low[i] - b.low[i]), std::abs(a.high[i] - b.high[i])});
  return most;
}

/// Parts of the boundary of `before` that have no like in `after`: each of that takes the part that
/// it is closest to.
template <int Dim>
void find_lost_parts(std::vector<BoundaryPart<Dim>> before,
                     const std::vector<BoundaryPart<Dim>>& after, std::vector<Box<Dim>>& places) {
  for (const BoundaryPart<Dim>& now : after) {
    auto best = before.end();
    for (auto old = before.begin(); old != before.end(); ++old)
      if (old->euler == now.euler &&
          (best == before.end() || difference(old->box, now.box) < difference(best->box, now.box)))
        best = old;
    if (best != before.end()) before.erase(best);
  }
  for (const BoundaryPart<Dim>& lost : before) places.push_back(lost.box);
}

}  // namespace

template <int Dim>
std::vector<Box<Dim>> damaged_places(const AdjacentMesh& before, const AdjacentMesh& after) {
  const Executor& executor = after.executor();
  std::vector<Box<Dim>> places;
  find_crossings<Dim>(executor, before.mesh(), after.mesh(), places);
  BoundarySurface<Dim> old(executor, sides_in<Dim>(before));
  BoundarySurface<Dim> now(executor, sides_in<Dim>(after));
  find_non_manifold<Dim>(after.mesh(), now, places);
  find_inner_facets<Dim>(before.mesh(), after.mesh(), now, places);
  if (places.empty())
    find_lost_parts(parts_of(before.mesh(), old), parts_of(after.mesh(), now), places);
  return places;
}

template <int Dim>
std::vector<std::uint32_t> boundary_vertices_near(const AdjacentMesh& mesh,
                                                  const std::vector<Box<Dim>>& places,
                                                  double distance) {
  const Executor& executor = mesh.executor();
  const BoxHierarchy<Dim> index(executor, places.size(), [&](std::size_t i) { return places[i]; });
  const auto sides = sides_in<Dim>(mesh);
  auto near = runtime::parallel_collect<std::uint32_t>(
      executor, sides.size(), [&](std::size_t s, auto&& append) {
        const auto box = grown(box_of<Dim>(mesh.mesh(), sides[s].corners), distance);
        bool found = false;
        index.each_meeting(box, [&](std::size_t) { found = true; });
        if (!found) return;
        for (const VertexId v : sides[s].corners) append(v);
      });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return {near.begin(), near.end()};
}

template std::vector<Box<2>> damaged_places<2>(const AdjacentMesh&, const AdjacentMesh&);
template std::vector<Box<3>> damaged_places<3>(const AdjacentMesh&, const AdjacentMesh&);
template std::vector<std::uint32_t> boundary_vertices_near(const AdjacentMesh&,
                                                           const std::vector<Box<2>>&, double);
template std::vector<std::uint32_t> boundary_vertices_near(const AdjacentMesh&,
                                                           const std::vector<Box<3>>&, double);

}  // namespace ductile::meshadapt
