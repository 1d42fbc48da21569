#include "geometry/boundary_parts.hpp"

#include <array>
#include <utility>

#include "ductile/runtime/worklist.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/distance.hpp"

namespace ductile::meshadapt {

template <int Dim>
void find_touching(BoundaryParts<Dim>& parts, double distance) {
  std::vector<Facet<Dim>> facets;
  std::vector<std::uint8_t> is_on_boundary(parts.mesh.vertex_slots());
  for (const TaggedFacet<Dim>& facet : parts.facets) {
    if (facet.other != none) continue;
    facets.push_back(facet.corners);
    for (const VertexId v : facet.corners) is_on_boundary[v] = 1;
  }
  const auto points = [&](std::size_t f) {
    std::array<Vector<Dim>, Dim> at;
    for (std::size_t i = 0; i < Dim; ++i) at[i] = parts.mesh.site_of[facets[f][i]].position;
    return at;
  };
  const BoxHierarchy<Dim> index(parts.executor, facets.size(),
                                [&](std::size_t f) { return box_around(points(f)); });
  using Contact = std::pair<VertexId, std::uint32_t>;  // and a facet
  const auto find = [&](std::size_t i, auto&& append) {
    const auto v = static_cast<VertexId>(i);
    if (is_on_boundary[v] == 0) return;
    const Vector<Dim>& at = parts.mesh.site_of[v].position;
    index.each_meeting(grown(box_around(std::array{at}), distance), [&](std::size_t g) {
      if (contains(facets[g], v) || norm(closest_point(points(g), at) - at) > distance) return;
      append(Contact{v, static_cast<std::uint32_t>(g)});
    });
  };
  parts.kept.assign(parts.mesh.vertex_slots(), 0);
  for (const auto& [v, facet] :
       runtime::parallel_collect<Contact>(parts.executor, is_on_boundary.size(), find)) {
    parts.kept[v] = 1;
    for (const VertexId corner : facets[facet]) parts.kept[corner] = 1;
  }
}

template void find_touching(BoundaryParts<2>&, double);
template void find_touching(BoundaryParts<3>&, double);

}  // namespace ductile::meshadapt
