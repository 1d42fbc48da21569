/// @file
/// The options of adaptation from a DM's DMPlexMetric parameters.
#pragma once

#include "distributed/adapt_parts.hpp"
#include "plex.hpp"

namespace ductile::petsc {

struct Parameters {
  AdaptPartsOptions options;
  int verbosity = -1;  ///< from 1 on, prints a line for each pass
};

/// Uses gradation factor, Hausdorff number, smallest and largest size, the switches for insertion,
/// swapping, movement and surface changes, the number of iterations and the verbosity. An iteration
/// is at most two passes: in each, one of two ranks takes what lies beyond their interface. The
/// Hausdorff number is used if it is not PETSc's default of 0.01, which nobody has chosen, or if a
/// geometry is composed with the mesh; otherwise curved boundaries keep their facets. Target
/// complexity, order of normalisation and largest anisotropy have been used by
/// DMPlexMetricNormalize() already. Throws Error.
Parameters parameters_of(DM dm);

/// The number of threads of each rank, which -dm_ductile_threads may give. Collective.
int threads_of(const Communicator& comm, DM dm);

}  // namespace ductile::petsc
