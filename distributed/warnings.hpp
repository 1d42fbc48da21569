/// @file
/// warnings_of_ranks: gathers the warnings of all ranks on the first one.
#pragma once

#include "distributed/communicator.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::distributed {

/// On the first rank: the warnings of all ranks, each once, in the order of the ranks, and with
/// several ranks prefixed by their numbers ("ranks 0, 2: ..."). Empty on the others. Collective.
meshadapt::Warnings warnings_of_ranks(const Communicator& comm, const meshadapt::Warnings& own);

}  // namespace ductile::distributed
