/// @file
/// The command of the program `ductile-mpi`.
#pragma once

#include "command.hpp"

namespace ductile::petsc {

/// `adapt`, with the options of `ductile adapt` that are available on several ranks. A failure that
/// only one rank knows ends all of them, because the others may wait for it; others are thrown on
/// all ranks, as AgreedError except on the first. Collective.
const cli::Command& adapt_command();

}  // namespace ductile::petsc
