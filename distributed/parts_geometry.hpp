/// @file
/// The Geometry of a distributed mesh: the same on every rank, made from the elements of all parts
/// that touch the boundary, so that round boundaries stay round while parts are adapted.
#pragma once

#include <memory>

#include "distributed/communicator.hpp"
#include "distributed/interfaces.hpp"
#include "distributed/part.hpp"
#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// Makes the geometry of all parts, with the tolerance and the ridge angle of `make`; each rank
/// temporarily holds all elements that touch boundaries, interfaces and listed edges. Throws as
/// Geometry() does, as Error on all ranks. Collective.
std::shared_ptr<const meshadapt::Geometry> geometry_of_parts(
    const Communicator& comm, const runtime::Executor& executor, const Part& part,
    const meshadapt::MakeMeshOptions& make);

/// Does adapt() itself refine sizes at curved boundaries? Parts beyond an interface must then know.
bool bounds_curved_sizes(const meshadapt::AdaptOptions& options);

/// The factor by which sizes may grow; 0: no limit.
double growth_of(const meshadapt::AdaptOptions& options);

}  // namespace ductile::distributed
