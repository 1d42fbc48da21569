/// @file
/// Fields of a DMPlex as vectors of PETSc's: local ones, so many values for each vertex or cell, in
/// the order of the DMPlex, those of other ranks that it knows included.
#pragma once

#include <string>
#include <vector>

#include "adapt_parts.hpp"
#include "communicator.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/executor.hpp"
#include "plex.hpp"
#include "read_plex.hpp"

namespace ductile::petsc {

/// A vector that is to be carried, and how.
struct CarriedVector {
  std::string name;  ///< for messages
  Vec values;
  meshadapt::NamedField::Place place;
  meshadapt::Carrying carrying;
};

/// The vectors on the mesh `after`, which has no overlap; the caller's. Throws Error, on all ranks.
/// Collective.
std::vector<Vec> carry_vectors(const Communicator& comm, const runtime::Executor& executor,
                               DM before, const std::vector<CarriedVector>& vectors, DM after);

/// Carries the vectors that are composed with `before` under the names that -dm_ductile_fields and
/// -dm_ductile_cell_fields list, by value those of -dm_ductile_by_value, and composes what comes
/// out with `after`. Composes the metric that was adapted to as "ductile_metric" with it: a tensor
/// for each vertex, row by row. Throws Error, on all ranks. Collective.
void compose_vectors(const Communicator& comm, const runtime::Executor& executor, DM before,
                     const AdaptedParts& parts, DM after);

}  // namespace ductile::petsc
