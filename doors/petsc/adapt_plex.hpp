/// @file
/// adapt_plex: the adaptor behind DMAdaptMetric() and DMAdaptLabel().
#pragma once

#include <petscdmplex.h>

namespace ductile::petsc {

/// Adapts a DMPlex to a metric, or by the flags of the first label if there is no metric. The
/// labels of facets and of cells to be kept may be null. Returns an error code, the same on all
/// ranks; never throws. Collective.
PetscErrorCode adapt_plex(DM dm, Vec metric, DMLabel facets, DMLabel cells, DM* adapted);

}  // namespace ductile::petsc
