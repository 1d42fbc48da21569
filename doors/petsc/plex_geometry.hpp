/// @file
/// The caller's geometry over several calls: a DMPlex composed with the adapted one as
/// "ductile_geometry".
#pragma once

#include <memory>

#include "distributed/communicator.hpp"
#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/runtime/executor.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// Is a geometry composed with `dm`? Throws InputError if it is no DM.
bool has_geometry(DM dm);

/// The geometry of the composed mesh, from labels of the same names; null without one. It is made
/// once for each tolerance and kept with that mesh. Throws Error, on all ranks. Collective.
std::shared_ptr<const meshadapt::Geometry> geometry_of_plex(const Communicator& comm,
                                                            const runtime::Executor& executor,
                                                            DM dm, const CarriedLabels& labels,
                                                            const meshadapt::MakeMeshOptions& make);

/// Composes the geometry of `before`, if any, with `after`.
void pass_geometry_on(DM before, DM after);

}  // namespace ductile::petsc
