/// @file
/// Surface: the curved boundaries, interfaces and curves of a mesh as they were before it was
/// adapted, and how far from them adaptation may go.
#pragma once

#include <utility>
#include <vector>

#include "ductile/meshadapt/mesh.hpp"
#include "geometry/sheets.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Surface {
  using Facets = Sheets<Dim, Dim>;
  using Edges = Sheets<Dim, 2>;

  Facets facets;  ///< of all patches, by PatchId
  Edges edges;    ///< of smooth curves, by CurveId; 3D only

  Surface(std::vector<typename Facets::Part> facet_parts,
          std::vector<typename Edges::Part> edge_parts, double tolerance)
      : facets(std::move(facet_parts), tolerance), edges(std::move(edge_parts), tolerance) {}
};

}  // namespace ductile::meshadapt
