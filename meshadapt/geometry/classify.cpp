#include "geometry/classify.hpp"

#include <utility>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/boundary_parts.hpp"

namespace ductile::meshadapt {
namespace {

template <int Dim>
void store_patches(const BoundaryParts<Dim>& parts) {
  runtime::parallel_for(parts.executor, parts.facets.size(), [&](std::size_t i) {
    const TaggedFacet<Dim>& f = parts.facets[i];
    parts.mesh.patches_of[f.element][static_cast<std::size_t>(f.facet)] = f.patch;
    if (f.other != none)
      parts.mesh.patches_of[f.other][static_cast<std::size_t>(f.other_facet)] = f.patch;
  });
}

}  // namespace

template <int Dim>
void classify(const runtime::Executor& executor, Mesh<Dim>& mesh,
              std::vector<TaggedFacet<Dim>> facets, const std::vector<ListedEdge>& edges,
              const MakeMeshOptions& options) {
  BoundaryParts<Dim> parts(executor, mesh, std::move(facets), edges, options);
  const bool bends = parts.within.surface > 0;
  std::vector<CurveEdge> curve_edges;
  classify_patches(parts);
  if constexpr (Dim == 3) curve_edges = find_curve_edges(parts);
  if (bends && parts.reference == nullptr) denoise(parts, curve_edges);
  if constexpr (Dim == 3) classify_curves(parts, curve_edges);
  mark_crack_sides(parts);
  store_patches(parts);
  if (bends)
    mesh.surface = parts.reference != nullptr ? parts.reference->surface
                                              : make_surface<Dim>(parts, curve_edges);
  classify_vertices(parts);
  if (parts.is_rough() || (parts.rounding && parts.rounding->noise > 0))
    mesh.rounding = std::move(parts.rounding);
}

template void classify(const runtime::Executor&, Mesh<2>&, std::vector<TaggedFacet<2>>,
                       const std::vector<ListedEdge>&, const MakeMeshOptions&);
template void classify(const runtime::Executor&, Mesh<3>&, std::vector<TaggedFacet<3>>,
                       const std::vector<ListedEdge>&, const MakeMeshOptions&);

}  // namespace ductile::meshadapt
