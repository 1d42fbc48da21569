/// @file
/// read_plex: a DMPlex as parts. Cells of an overlap are left out.
#pragma once

#include "communicator.hpp"
#include "part.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// What each rank owns of a mesh.
struct PlexPart {
  Part part;                       ///< without the metric
  std::vector<PetscInt> point_of;  ///< [vertex], counted from the first vertex of the DMPlex
  std::vector<PetscInt> cell_of;   ///< [element]
};

/// Throws Error, on all ranks, if the mesh is not one of triangles in the plane or tetrahedra.
/// Collective.
PlexPart read_plex(const Communicator& comm, DM dm, const CarriedLabels& labels);

}  // namespace ductile::petsc
