/// @file
/// migrate: moves elements to other ranks, with their vertices, the metric there, their facets and
/// their edges.
#pragma once

#include <cstdint>
#include <vector>

#include "communicator.hpp"
#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// Numbers all vertices in the order of ranks; the first rank that has a shared vertex numbers it,
/// so the numbers of each rank are consecutive. Returns how many this rank numbered. Collective.
std::int64_t number_vertices(const Communicator& comm, const Interfaces& interfaces, Part& part);

/// Sends each element, with its vertices, facets and edges, to the rank in target_of, and makes a
/// part of the received ones, in the order of the sending ranks. Collective.
template <int Dim>
Part migrate(const Communicator& comm, const runtime::Executor& executor, const Part& part,
             const std::vector<int>& target_of);

/// The whole mesh on the first rank, in the order of the ranks, and empty parts on the others; with
/// one rank, the part itself. Collective.
Part gather_on_first(const Communicator& comm, const runtime::Executor& executor, const Part& part);

/// The whole mesh on each rank, in the order of the ranks. Collective.
template <int Dim>
Part gather_everywhere(const Communicator& comm, const runtime::Executor& executor,
                       const Part& part);

extern template Part gather_everywhere<2>(const Communicator&, const runtime::Executor&,
                                          const Part&);
extern template Part gather_everywhere<3>(const Communicator&, const runtime::Executor&,
                                          const Part&);
extern template Part migrate<2>(const Communicator&, const runtime::Executor&, const Part&,
                                const std::vector<int>&);
extern template Part migrate<3>(const Communicator&, const runtime::Executor&, const Part&,
                                const std::vector<int>&);

}  // namespace ductile::petsc
