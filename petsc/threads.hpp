/// @file
/// How many threads each rank works with.
#pragma once

#include "communicator.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// -dm_ductile_threads, or OMP_NUM_THREADS; otherwise the cores that the rank is bound to, or,
/// where the ranks of a machine may all use the same cores, its share of them. Collective.
int threads_of(const Communicator& comm, DM dm);

}  // namespace ductile::petsc
