/// @file
/// grade: limits how fast sizes grow over the whole distributed mesh, not only within each part.
#pragma once

#include "communicator.hpp"
#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// Refines the target until sizes grow by at most `factor` per unit of metric length, as
/// limit_gradation() does, across interfaces too: alternately grades parts and intersects metrics
/// at shared vertices. A factor of 0 only intersects. Throws as limit_gradation() does, as Error on
/// all ranks. Collective.
template <int Dim>
void grade(const Communicator& comm, const runtime::Executor& executor, Part& part,
           const Interfaces& interfaces, double factor);

extern template void grade<2>(const Communicator&, const runtime::Executor&, Part&,
                              const Interfaces&, double);
extern template void grade<3>(const Communicator&, const runtime::Executor&, Part&,
                              const Interfaces&, double);

}  // namespace ductile::petsc
