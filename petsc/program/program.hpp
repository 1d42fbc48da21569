/// @file
/// The command of the program `ductile-mpi`.
#pragma once

#include <span>
#include <string>

#include "communicator.hpp"

namespace ductile::petsc {

/// Adapts a mesh on all ranks, with the arguments after `adapt`. Throws Ended or AgreedError; other
/// exceptions are thrown on one rank only. Collective.
void adapt_files(const Communicator& comm, std::span<const std::string> words);

/// Prints the help of `adapt`.
void print_help_of_adapt();

}  // namespace ductile::petsc
