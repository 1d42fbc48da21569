/// @file
/// The number of threads of each rank.
#pragma once

#include <optional>

#include "communicator.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// The given number, or OMP_NUM_THREADS; otherwise the number of cores that the rank is bound to,
/// or its share if all ranks of a machine may use the same cores. Collective.
int threads_of(const Communicator& comm, std::optional<int> given);
/// The same; -dm_ductile_threads gives the number. Collective.
int threads_of(const Communicator& comm, DM dm);

}  // namespace ductile::petsc
