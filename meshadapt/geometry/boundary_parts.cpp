#include "geometry/boundary_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/unit.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {
namespace {

/// Flat and straight mean: within this fraction of the mesh's extent of one plane or line; or as
/// far from one as rounding explains (see rough_parts.hpp).
constexpr double flatness = 1e-10;
/// As a share of the extent. Coordinates that seem to be rounded by this much are round numbers by
/// choice.
constexpr double coarsest = 0.02;

template <int Dim>
double extent_of(const runtime::Executor& executor, const Mesh<Dim>& mesh) {
  VertexId first = 0;
  while (first < mesh.vertex_slots() && !mesh.vertex_alive(first)) ++first;
  const auto distance = [&](std::size_t v) {
    if (!mesh.vertex_alive(static_cast<VertexId>(v))) return 0.0;
    return norm(mesh.site_of[v].position - mesh.site_of[first].position);
  };
  return runtime::parallel_reduce(executor, mesh.vertex_slots(), 0.0, distance,
                                  [](double a, double b) { return std::max(a, b); });
}

}  // namespace

template <int Dim>
BoundaryParts<Dim>::BoundaryParts(const runtime::Executor& run_on, Mesh<Dim>& of,
                                  std::vector<TaggedFacet<Dim>> all,
                                  const std::vector<ListedEdge>& edges,
                                  const MakeMeshOptions& made_with)
    : executor(run_on),
      mesh(of),
      options(made_with),
      facets(std::move(all)),
      extent(extent_of(executor, mesh)),
      within{flatness * extent, options.hausdorff_tolerance,
             std::cos(options.ridge_angle * std::numbers::pi / 180)},
      sides(executor, facets.size(), [&](std::size_t f) { return facets[f].corners; }) {
  if (options.geometry && within.surface > 0) reference = options.geometry->surface<Dim>();
  if (reference != nullptr) reference_sheets = reference->sheets_of(executor, mesh, facets);
  if constexpr (Dim == 3)
    for (const ListedEdge& edge : edges) listed.emplace(edge_key(edge.a, edge.b), edge);
}

template <int Dim>
double BoundaryParts<Dim>::rounding_tolerance() {
  if (rounding) return rounding->tolerance;
  rounding = std::make_shared<Rounding<Dim>>();
  std::vector<bool> seen(mesh.vertex_slots());
  PrecisionFinder finder;
  const auto add = [&](VertexId v) {
    if (seen[v]) return true;
    seen[v] = true;
    const auto& x = mesh.site_of[v].position.x;
    return std::all_of(x.begin(), x.end(), [&](double value) { return finder.add(value); });
  };
  const auto add_all = [&](const auto& corners) {
    return std::all_of(corners.begin(), corners.end(), add);
  };
  for (const TaggedFacet<Dim>& f : facets)
    if (!add_all(f.corners)) return 0;
  for (const auto& [key, edge] : listed)
    if (!add_all(std::array{edge.a, edge.b})) return 0;
  rounding->precision = finder.precision();
  const double found = meshadapt::rounding_tolerance<Dim>(rounding->precision);
  const bool matters = found > within.flat && found < coarsest * extent;
  return rounding->tolerance = matters ? found : 0;
}

template <int Dim>
Vector<Dim> BoundaryParts<Dim>::direction(std::uint32_t facet) const {
  if (is_noise(facet)) return noise_normals[facet];
  return unit(normal_of<Dim>(mesh, outward_corners(mesh, facets[facet])));
}

template <int Dim>
bool BoundaryParts<Dim>::turns_little(std::uint32_t f, std::uint32_t g, SideKey key) const {
  const Facet<Dim>&p = facets[f].corners, &q = facets[g].corners;
  const Vector<Dim> u = away_from<Dim>(mesh, p, key), v = away_from<Dim>(mesh, q, key);
  if (dot(u, v) < -within.least_turn * norm(u) * norm(v)) return true;
  if (!is_noise(f) && !is_noise(g)) return false;
  const double side = face_alike(mesh, facets[f], facets[g]) ? 1 : -1;
  return side * dot(direction(f), direction(g)) > within.least_turn;
}

template <int Dim>
bool BoundaryParts<Dim>::is_sharp(std::span<const FacetSide> both) const {
  const std::uint32_t f = both[0].facet, g = both[1].facet;
  return mesh.patches[facets[f].patch].smooth && !turns_little(f, g, both[0].key);
}

template <int Dim>
std::vector<PatchId> BoundaryParts<Dim>::patches_at(SideKey key) const {
  std::vector<PatchId> patches;
  for (const FacetSide& side : sides.at(key)) patches.push_back(facets[side.facet].patch);
  std::sort(patches.begin(), patches.end());
  return patches;
}

template struct BoundaryParts<2>;
template struct BoundaryParts<3>;

}  // namespace ductile::meshadapt
