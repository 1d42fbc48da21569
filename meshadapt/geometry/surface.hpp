/// @file
/// Surface: a smooth model of the boundaries, interfaces and curves of a mesh as they were before
/// it was adapted, and how far from it adaptation may go.
#pragma once

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
  Samples<Dim, Dim> facet_samples;
  Samples<Dim, 2> edge_samples;
};

/// The distance that a mesh may have from the surface given for it, in tolerances.
inline constexpr double fitting = 2;

}  // namespace ductile::meshadapt
