/// @file
/// Surface: a smooth model of the boundaries, interfaces and curves of a mesh as they were before
/// it was adapted, and how far from it adaptation may go.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/classify.hpp"
#include "geometry/sheets.hpp"
#include "geometry/smooth_model.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Surface {
  using Facets = Sheets<Dim, Dim>;
  using Edges = Sheets<Dim, 2>;

  Facets facets;  ///< of all patches, by PatchId
  Edges edges;    ///< of smooth curves, by CurveId; 3D only
};

/// An edge of a curve, in 3D.
struct SurfaceEdge {
  VertexId a, b;
  CurveId curve;
};

struct SurfaceOptions {
  double tolerance;   ///< how far facets may be from the model, and the model from facets
  double flat;        ///< what is within this distance of one line is straight
  double least_turn;  ///< cosine of the angle from which on curves have corners
};

/// Of a mesh whose patches and curves are known; null if none is smooth. `plane_of`, [facet], tells
/// which facets of a patch are coplanar. Linear, times a logarithm. Throws std::bad_alloc. Thread
/// safety: one caller; runs on the executor.
template <int Dim>
std::shared_ptr<const Surface<Dim>> make_surface(const runtime::Executor& executor,
                                                 const Mesh<Dim>& mesh,
                                                 std::span<const TaggedFacet<Dim>> facets,
                                                 std::span<const PatchId> plane_of,
                                                 std::span<const SurfaceEdge> edges,
                                                 const SurfaceOptions& options);

extern template std::shared_ptr<const Surface<2>> make_surface(
    const runtime::Executor&, const Mesh<2>&, std::span<const TaggedFacet<2>>,
    std::span<const PatchId>, std::span<const SurfaceEdge>, const SurfaceOptions&);
extern template std::shared_ptr<const Surface<3>> make_surface(
    const runtime::Executor&, const Mesh<3>&, std::span<const TaggedFacet<3>>,
    std::span<const PatchId>, std::span<const SurfaceEdge>, const SurfaceOptions&);

}  // namespace ductile::meshadapt
