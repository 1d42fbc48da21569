/// @file
/// warnings_of_ranks: gathers the warnings of all ranks on the first one.
#pragma once

#include "communicator.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::petsc {

/// On the first rank: what ranks warn of, each once, in the order of the ranks, after the numbers
/// of those that do ("ranks 0, 2: ..."), if there are several ranks. Nothing on the others.
/// Collective.
meshadapt::Warnings warnings_of_ranks(const Communicator& comm, const meshadapt::Warnings& own);

}  // namespace ductile::petsc
