/// @file
/// write_plex: parts as a DMPlex, interpolated, without an overlap, with its labels.
#pragma once

#include "adapt_parts.hpp"
#include "communicator.hpp"
#include "plex.hpp"

namespace ductile::petsc {

/// The mesh is the caller's. Collective.
DM write_plex(const Communicator& comm, const AdaptedParts& parts, const CarriedLabels& labels);

}  // namespace ductile::petsc
