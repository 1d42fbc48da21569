/// @file
/// Surface: a smooth model of the boundaries, interfaces and curves of a mesh as they were before
/// it was adapted, and how far from it adaptation may go.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "geometry/classify.hpp"
#include "geometry/sheets.hpp"
#include "geometry/smooth_model.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Surface {
  using Facets = Sheets<Dim, Dim>;
  using Edges = Sheets<Dim, 2>;

  Facets facets;  ///< of all patches, by PatchId
  Edges edges;    ///< of smooth curves, by CurveId; 3D only
};

/// The distance that a mesh may have from the surface given for it, in tolerances.
inline constexpr double fitting = 2;

/// An edge of a curve, in 3D.
struct SurfaceEdge {
  VertexId a, b;
  CurveId curve;
  std::array<PatchId, 2> patches;  ///< that meet there; the second is 0 if there is no other
};

struct SurfaceOptions {
  double tolerance;   ///< how far facets may be from the model, and the model from facets
  double flat;        ///< what is within this distance of one line is straight
  double least_turn;  ///< cosine of the angle from which on curves have corners
  std::span<const SurfaceFunction> functions;  ///< see MakeMeshOptions
};

/// The facets and curves of a mesh, all of which have their patches.
template <int Dim>
struct ClassifiedFacets {
  std::span<const TaggedFacet<Dim>> facets;
  std::span<const PatchId> plane_of;     ///< [facet], the same of those of one patch in one plane
  std::span<const Vector<Dim>> normals;  ///< [facet], see wide_normals()
  std::span<const SurfaceEdge> edges;
  std::span<const Vector<Dim>> places;  ///< [vertex], see levelled_places()
};

/// Null if no patch or curve of the mesh is smooth. Linear, times a logarithm. Throws
/// std::bad_alloc. Thread safety: one caller; runs on the executor.
template <int Dim>
std::shared_ptr<const Surface<Dim>> make_surface(const runtime::Executor& executor,
                                                 const Mesh<Dim>& mesh,
                                                 const ClassifiedFacets<Dim>& classified,
                                                 const SurfaceOptions& options);

extern template std::shared_ptr<const Surface<2>> make_surface(const runtime::Executor&,
                                                               const Mesh<2>&,
                                                               const ClassifiedFacets<2>&,
                                                               const SurfaceOptions&);
extern template std::shared_ptr<const Surface<3>> make_surface(const runtime::Executor&,
                                                               const Mesh<3>&,
                                                               const ClassifiedFacets<3>&,
                                                               const SurfaceOptions&);

}  // namespace ductile::meshadapt
