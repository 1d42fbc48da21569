/// @file
/// The metric of a DMPlex as the field of a part.
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/part.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"
#include "plex.hpp"
#include "read_plex.hpp"

namespace ductile::petsc {

/// The metric in a PETSc vector that is local to each rank, at the vertices of a part: a full
/// tensor, row by row, or a factor of the unit tensor, for each vertex of the DMPlex or one for all
/// (DMPlexMetricIsIsotropic(), DMPlexMetricIsUniform()). Throws InputError, on all ranks, if the
/// length is wrong or a value is not a metric within the bounds on sizes. Collective.
AnyField metric_of_vector(const Communicator& comm, DM dm, Vec vector, const PlexPart& part,
                          const meshadapt::SizeBounds& bounds);

/// The metric for a label of cells: the sizes of the mesh, half of them in cells marked
/// DM_ADAPT_REFINE, twice in those marked DM_ADAPT_COARSEN. Refinement wins at vertices of both.
/// Collective.
AnyField metric_of_label(const Communicator& comm, const runtime::Executor& executor, DMLabel label,
                         const PlexPart& part);

}  // namespace ductile::petsc
