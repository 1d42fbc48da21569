/// @file
/// write_plex: makes an interpolated DMPlex from parts, without an overlap, with its labels.
#pragma once

#include "distributed/adapt_parts.hpp"
#include "distributed/communicator.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// The caller owns the mesh. Collective.
DM write_plex(const Communicator& comm, const AdaptedParts& parts, const CarriedLabels& labels);

}  // namespace ductile::petsc
