#include "geometry/reference_surface.hpp"

#include <algorithm>
#include <string>

#include "core/first_bad.hpp"
#include "core/unit.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/facet_sides.hpp"

namespace ductile::meshadapt {

namespace {

/// The distance within which a facet's sheet is looked for, in tolerances.
constexpr double near = 50;

template <int Dim>
Vector<Dim> centre_of(const Mesh<Dim>& mesh, const Facet<Dim>& facet) {
  Vector<Dim> centre;
  for (const VertexId v : facet) centre += (1.0 / Dim) * mesh.site_of[v].position;
  return centre;
}

}  // namespace

template <int Dim>
std::vector<std::uint32_t> ReferenceSurface<Dim>::sheets_of(
    const runtime::Executor& executor, const Mesh<Dim>& mesh,
    const std::vector<TaggedFacet<Dim>>& facets) const {
  std::vector<std::uint32_t> sheet_of(facets.size(), none);
  if (!surface) return sheet_of;
  const double tolerance = surface->facets.tolerance();
  std::vector<double> distance_of(facets.size());
  runtime::parallel_for(executor, facets.size(), [&](std::size_t f) {
    if (facets[f].data.required) return;
    const Facet<Dim> corners = facet_of<Dim>(mesh.corners_of[facets[f].element], facets[f].facet);
    const Vector<Dim> normal = normal_of<Dim>(mesh, corners);
    const Vector<Dim> centre = centre_of<Dim>(mesh, corners);
    const std::int32_t reference = facets[f].data.reference;
    auto nearest =
        surface->facets.nearest(centre, unit(normal), reference_of, reference, near * tolerance);
    if (!nearest || (is_smooth[nearest->sheet] != 0 && nearest->distance > fitting * tolerance)) {
      const auto noise = surface->facets.nearest(centre, fitting * tolerance);
      if (noise && reference_of[noise->sheet] == reference) nearest = noise;
    }
    if (!nearest) return;
    sheet_of[f] = nearest->sheet;
    distance_of[f] = is_smooth[nearest->sheet] != 0 ? nearest->distance : 0;
  });
  const auto is_curved = [&](std::uint32_t sheet) {
    return sheet != none && is_smooth[sheet] != 0;
  };
  const bool bends =
      std::any_of(is_smooth.begin(), is_smooth.end(), [](std::uint8_t is) { return is != 0; });
  const bool is_free = std::any_of(facets.begin(), facets.end(), [](const TaggedFacet<Dim>& facet) {
    return !facet.data.required;
  });
  if (!in_parts && bends && is_free && std::none_of(sheet_of.begin(), sheet_of.end(), is_curved))
    throw InputError("geometry: none of the facets of the mesh is within " +
                     number(near * tolerance) +
                     " of one of its curved boundaries with the same reference; expected the "
                     "geometry of the same domain");
  const auto farthest = std::max_element(distance_of.begin(), distance_of.end());
  if (farthest != distance_of.end() && *farthest > fitting * tolerance) {
    const auto f = static_cast<std::size_t>(farthest - distance_of.begin());
    std::string vertices;
    for (const VertexId v : facets[f].corners) vertices += " " + std::to_string(v + 1);
    throw InputError("the boundary's facet with the vertices" + vertices + " is " +
                     number(*farthest) + " from the geometry, of which the tolerance is " +
                     number(tolerance) +
                     "; is the geometry that of another domain, or was the mesh adapted without "
                     "it or with a larger tolerance?");
  }
  return sheet_of;
}

template <int Dim>
std::uint32_t ReferenceSurface<Dim>::sheet_of_edge(const std::array<Vector<Dim>, 2>& ends,
                                                   std::int32_t reference) const {
  if (!surface) return none;
  const Vector<Dim> along = ends[1] - ends[0];
  const auto nearest =
      surface->edges.nearest(0.5 * (ends[0] + ends[1]), unit(along), reference_of_curve, reference,
                             fitting * surface->edges.tolerance());
  return nearest ? nearest->sheet : none;
}

template struct ReferenceSurface<2>;
template struct ReferenceSurface<3>;

}  // namespace ductile::meshadapt
