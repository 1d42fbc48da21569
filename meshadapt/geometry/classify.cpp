#include "geometry/classify.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/boundary_parts.hpp"
#include "geometry/classify_curves.hpp"
#include "geometry/classify_patches.hpp"
#include "geometry/classify_vertices.hpp"
#include "geometry/crack_sides.hpp"
#include "geometry/levelled.hpp"
#include "geometry/surface.hpp"

namespace ductile::meshadapt {
namespace {

/// Two different patches of a sorted list; 0 if there is no other.
std::array<PatchId, 2> first_two(const std::vector<PatchId>& patches) {
  if (patches.empty()) return {};
  return {patches.front(), patches.back() == patches.front() ? 0 : patches.back()};
}

/// Sets mesh.surface: what smooth patches and curves are like, and what their facets must not come
/// close to.
template <int Dim>
void keep_surface(BoundaryParts<Dim>& parts, const std::vector<CurveEdge>& curve_edges) {
  if (parts.reference != nullptr) {
    parts.mesh.surface = parts.reference->surface;
    return;
  }
  std::vector<SurfaceEdge> edges;
  edges.reserve(curve_edges.size());
  for (const CurveEdge& e : curve_edges) edges.push_back({e.a, e.b, e.curve, first_two(e.patches)});
  parts.mesh.surface = make_surface<Dim>(
      parts.executor, parts.mesh,
      {parts.facets, parts.plane_of, parts.wide_normals, edges, parts.places},
      {parts.hausdorff_tolerance, parts.tolerance, parts.least_turn, parts.options.functions});
}

template <int Dim>
void store_patches(const BoundaryParts<Dim>& parts) {
  runtime::parallel_for(parts.executor, parts.facets.size(), [&](std::size_t i) {
    const TaggedFacet<Dim>& f = parts.facets[i];
    parts.mesh.patches_of[f.element][static_cast<std::size_t>(f.facet)] = f.patch;
    if (f.other != none)
      parts.mesh.patches_of[f.other][static_cast<std::size_t>(f.other_facet)] = f.patch;
  });
}

/// Sets `places`: where vertices would be without noise.
template <int Dim>
void level(BoundaryParts<Dim>& parts, const std::vector<CurveEdge>& curve_edges) {
  std::vector<std::uint8_t> held = parts.kept;
  for (VertexId v = 0; v < held.size(); ++v)
    if (parts.mesh.kind_of[v].corner || parts.mesh.kind_of[v].required) held[v] = 1;
  for (const TaggedFacet<Dim>& facet : parts.facets)
    if (parts.mesh.patches[facet.patch].required)
      for (const VertexId v : facet.corners) held[v] = 1;
  if constexpr (Dim == 2)
    for (std::size_t i = 0; i < parts.sides.size(); ++i) {
      if (!parts.sides.begins_run(i)) continue;
      const auto both = parts.sides.run_at(i);
      if (both.size() != 2 ||
          parts.facets[both[0].facet].patch != parts.facets[both[1].facet].patch ||
          parts.is_sharp(both))
        held[static_cast<VertexId>(both[0].key)] = 1;
    }
  std::vector<std::array<VertexId, 2>> edges;
  edges.reserve(curve_edges.size());
  for (const CurveEdge& edge : curve_edges) {
    edges.push_back({edge.a, edge.b});
    if (edge.data.required) held[edge.a] = held[edge.b] = 1;
  }
  parts.places = levelled_places<Dim>(
      parts.executor, parts.mesh,
      {parts.facets, parts.wide_normals, edges, held, parts.hausdorff_tolerance, parts.least_turn});
}

}  // namespace

template <int Dim>
void classify(const runtime::Executor& executor, Mesh<Dim>& mesh,
              std::vector<TaggedFacet<Dim>> facets, const std::vector<ListedEdge>& edges,
              const MakeMeshOptions& options) {
  BoundaryParts<Dim> parts(executor, mesh, std::move(facets), edges, options);
  const bool bends = parts.hausdorff_tolerance > 0;
  std::vector<CurveEdge> curve_edges;
  classify_patches(parts);
  if constexpr (Dim == 3) curve_edges = find_curve_edges(parts);
  if (bends && parts.reference == nullptr) level(parts, curve_edges);
  if constexpr (Dim == 3) classify_curves(parts, curve_edges);
  mark_crack_sides(executor, mesh, parts.facets, parts.sides,
                   parts.is_rough() ? parts.rounding->tolerance : parts.tolerance);
  store_patches(parts);
  if (bends) keep_surface(parts, curve_edges);
  classify_vertices(parts);
  if (parts.is_rough()) mesh.rounding = std::move(parts.rounding);
}

template void classify(const runtime::Executor&, Mesh<2>&, std::vector<TaggedFacet<2>>,
                       const std::vector<ListedEdge>&, const MakeMeshOptions&);
template void classify(const runtime::Executor&, Mesh<3>&, std::vector<TaggedFacet<3>>,
                       const std::vector<ListedEdge>&, const MakeMeshOptions&);

}  // namespace ductile::meshadapt
