/// @file
/// Curves of a 3D mesh: edges where patches meet or that the file lists, chained where they are
/// straight or, with a tolerance, smooth.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "geometry/boundary_parts.hpp"

namespace ductile::meshadapt {

/// An edge of a curve.
struct CurveEdge {
  VertexId a, b;
  Curve data;
  std::vector<PatchId> patches;  // sorted
  CurveId curve = 0;
  bool bends = false;          ///< more than rounding makes it
  std::uint32_t sheet = none;  ///< the curve of the reference that it stands for
  bool agrees_with(const CurveEdge& o) const {
    return std::tie(data.reference, data.listed, data.required, data.ridge, patches, sheet) ==
           std::tie(o.data.reference, o.data.listed, o.data.required, o.data.ridge, o.patches,
                    o.sheet);
  }
};

/// The edges, which belong to no curve yet. Thread safety: one caller; runs on the executor.
std::vector<CurveEdge> find_curve_edges(const BoundaryParts<3>& parts);

/// Gives them their curves: sets mesh.curves and links_of. Looks at `places`. Thread safety: one
/// caller.
void classify_curves(BoundaryParts<3>& parts, std::vector<CurveEdge>& edges);

}  // namespace ductile::meshadapt
