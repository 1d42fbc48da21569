/// @file
/// What a DM's DMPlexMetric parameters say of the adaptation.
#pragma once

#include "adapt_parts.hpp"
#include "plex.hpp"

namespace ductile::petsc {

struct Parameters {
  AdaptPartsOptions options;
  int verbosity = -1;  ///< a line for each pass from 1 on
};

/// Gradation factor, Hausdorff number, smallest and largest size, no insertion, swapping, movement
/// or change of the surface, the number of iterations and the verbosity. An iteration is two passes
/// at most: in each, one of two ranks takes what lies beyond the interface between them. A
/// Hausdorff number counts if it is not PETSc's default of 0.01, a length that nobody has chosen,
/// or if a geometry is composed with the mesh. Otherwise boundaries keep the facets that they have,
/// except where these are flat. Target complexity, order of normalisation and largest anisotropy
/// are for DMPlexMetricNormalize(), which has used them. Throws Error.
Parameters parameters_of(DM dm);

}  // namespace ductile::petsc
