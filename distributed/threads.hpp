/// @file
/// The number of threads of each rank.
#pragma once

#include <optional>

#include "distributed/communicator.hpp"

namespace ductile::distributed {

/// The given number, or OMP_NUM_THREADS; otherwise the number of cores that the rank is bound to,
/// or its share if all ranks of a machine may use the same cores. Collective.
int threads_of(const Communicator& comm, std::optional<int> given);

}  // namespace ductile::distributed
