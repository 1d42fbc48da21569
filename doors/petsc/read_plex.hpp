/// @file
/// read_plex: reads a DMPlex as parts, without cells of an overlap.
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/part.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// The cells that each rank owns.
struct PlexPart {
  Part part;                       ///< without the metric
  std::vector<PetscInt> point_of;  ///< [vertex], counted from the first vertex of the DMPlex
  std::vector<PetscInt> cell_of;   ///< [element]
};

/// Throws Error, on all ranks, if the mesh does not consist of planar triangles or of tetrahedra.
/// Collective.
PlexPart read_plex(const Communicator& comm, DM dm, const CarriedLabels& labels);

}  // namespace ductile::petsc
