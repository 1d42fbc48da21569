/// @file
/// The Geometry of a distributed mesh: the same on every rank, made of the elements of all parts
/// that touch the boundary, so that what is round stays so while parts of it are adapted.
#pragma once

#include <memory>

#include "communicator.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// Of all parts together; each rank holds a copy of the elements that touch boundaries, interfaces
/// and listed edges meanwhile. With the tolerance and the ridge angle of `make`. Throws as
/// Geometry() does, as Error on all ranks. Collective.
std::shared_ptr<const meshadapt::Geometry> geometry_of_parts(
    const Communicator& comm, const runtime::Executor& executor, const Part& part,
    const meshadapt::MakeMeshOptions& make);

/// Whether adapt() makes sizes at curved boundaries finer by itself, which parts beyond an
/// interface have to know of.
bool bounds_curved_sizes(const meshadapt::AdaptOptions& options);

/// By how much sizes may grow; 0 for as much as is asked for.
double growth_of(const meshadapt::AdaptOptions& options);

}  // namespace ductile::petsc
