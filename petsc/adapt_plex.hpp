/// @file
/// adapt_plex: what DMAdaptMetric() and DMAdaptLabel() call.
#pragma once

#include <petscdmplex.h>

namespace ductile::petsc {

/// Adapts a DMPlex to a metric, or by the flags of the first label if there is no metric. The
/// labels are those of facets and of cells that are to be kept; they may be null. Returns the code
/// of an error, the same on all ranks. Collective; it never throws.
PetscErrorCode adapt_plex(DM dm, Vec metric, DMLabel facets, DMLabel cells, DM* adapted);

}  // namespace ductile::petsc
