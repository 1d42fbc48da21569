/// @file
/// adapt_to_sizes: adapts the input on all ranks, repeatedly while sizes by places are not reached.
#pragma once

#include "distributed/adapt_parts.hpp"
#include "distributed/communicator.hpp"
#include "ductile/runtime/executor.hpp"
#include "input.hpp"

namespace ductile::petsc {

/// Adapts the mesh to its metric. The first rank, which gathers the adapted mesh, asks for the next
/// sizes by places. Throws AgreedError. Collective.
AdaptedParts adapt_to_sizes(const Communicator& comm, const runtime::Executor& executor,
                            Input& input, AdaptPartsOptions options);

}  // namespace ductile::petsc
