/// @file
/// adapt_to_sizes: adapts what files say, on all ranks, and again while sizes by places are
/// lacking.
#pragma once

#include "adapt_parts.hpp"
#include "communicator.hpp"
#include "ductile/runtime/executor.hpp"
#include "input.hpp"

namespace ductile::petsc {

/// Adapts the mesh to its metric. Sizes by places are evaluated again on the adapted mesh, as
/// meshadapt::adapt_to_sizes() does, by the first rank, where all of it is gathered. What the
/// first rank finds wrong with them is told there, and Ended is thrown; otherwise as adapt_parts().
/// Collective.
AdaptedParts adapt_to_sizes(const Communicator& comm, const runtime::Executor& executor,
                            const Input& input, AdaptPartsOptions options);

}  // namespace ductile::petsc
