/// @file
/// migrate: elements go to other ranks, with their vertices, the metric there, their facets and
/// their edges.
#pragma once

#include <cstdint>
#include <vector>

#include "communicator.hpp"
#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// Gives all vertices numbers, in the order of ranks; shared ones get theirs from the first rank
/// that has them, so that the numbers of each rank follow each other. Returns how many it gave.
/// Collective.
std::int64_t number_vertices(const Communicator& comm, const Interfaces& interfaces, Part& part);

/// Sends each element to the rank that target_of names, with its vertices, facets and edges, and
/// makes a part of what comes, in the order of the ranks that it comes from. Collective.
template <int Dim>
Part migrate(const Communicator& comm, const runtime::Executor& executor, const Part& part,
             const std::vector<int>& target_of);

/// The whole mesh on the first rank, in the order of the ranks, and empty parts on the others; on
/// one rank the part as it is. Collective.
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
