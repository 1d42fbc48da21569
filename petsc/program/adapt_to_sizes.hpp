/// @file
/// adapt_to_sizes: adapts the input on all ranks, repeatedly while sizes by places are not reached.
#pragma once

#include "distributed/adapt_parts.hpp"
#include "distributed/communicator.hpp"
#include "ductile/runtime/executor.hpp"
#include "input.hpp"

namespace ductile::petsc {

/// Adapts the mesh to its metric. The first rank, which gathers the adapted mesh, evaluates sizes
/// by places again, as meshadapt::adapt_to_sizes() does. Throws AgreedError. Collective.
AdaptedParts adapt_to_sizes(const Communicator& comm, const runtime::Executor& executor,
                            const Input& input, AdaptPartsOptions options);

}  // namespace ductile::petsc
