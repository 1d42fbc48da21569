/// @file
/// migrate: moves elements to other ranks, with their vertices, the metric there, their facets and
/// their edges.
#pragma once

#include <cstdint>
#include <vector>

#include "distributed/communicator.hpp"
#include "distributed/interfaces.hpp"
#include "distributed/part.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// Numbers all vertices in the order of ranks; the first rank that has a shared vertex numbers it,
/// so the numbers of each rank are consecutive. Returns how many this rank numbered. Collective.
std::int64_t number_vertices(const Communicator& comm, const Interfaces& interfaces, Part& part);

/// Sends each element, with its vertices, facets and edges, to the rank in target_of, and makes a
/// part of the received ones, in the order of the sending ranks. Collective.
Part migrate(const Communicator& comm, const runtime::Executor& executor, const Part& part,
             const std::vector<int>& target_of);

/// The whole mesh on the first rank, in the order of the ranks, and empty parts on the others; with
/// one rank, the part itself. Collective.
Part gather_on_first(const Communicator& comm, const runtime::Executor& executor, const Part& part);

/// The whole mesh on each rank, in the order of the ranks. Collective.
Part gather_everywhere(const Communicator& comm, const runtime::Executor& executor,
                       const Part& part);

}  // namespace ductile::distributed
