/// @file
/// How many threads each rank works with.
#pragma once

#include <optional>

#include "communicator.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// What is given, or OMP_NUM_THREADS; otherwise the cores that the rank is bound to, or,
/// where the ranks of a machine may all use the same cores, its share of them. Collective.
int threads_of(const Communicator& comm, std::optional<int> given);
/// The same; -dm_ductile_threads is what is given. Collective.
int threads_of(const Communicator& comm, DM dm);

}  // namespace ductile::petsc
