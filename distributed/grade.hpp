/// @file
/// grade: limits how fast sizes grow over the whole distributed mesh, not only within each part.
#pragma once

#include "distributed/communicator.hpp"
#include "distributed/interfaces.hpp"
#include "distributed/part.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// Refines the target until sizes grow by at most `factor` per unit of metric length, as
/// limit_gradation() does, across interfaces too: alternately grades parts and intersects metrics
/// at shared vertices. A factor of 0 only intersects. Throws as limit_gradation() does, as Error on
/// all ranks. Collective.
void grade(const Communicator& comm, const runtime::Executor& executor, Part& part,
           const Interfaces& interfaces, double factor);

}  // namespace ductile::distributed
