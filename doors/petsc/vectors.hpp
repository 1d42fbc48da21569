/// @file
/// Fields of a DMPlex as local PETSc vectors: values for each vertex or cell, in the order of the
/// DMPlex, including those that other ranks own.
#pragma once

#include <string>
#include <vector>

#include "distributed/adapt_parts.hpp"
#include "distributed/communicator.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/executor.hpp"
#include "plex.hpp"
#include "read_plex.hpp"

namespace ductile::petsc {

/// A vector to transfer, and the method.
struct CarriedVector {
  std::string name;  ///< for messages
  Vec values;
  meshadapt::NamedField::Place place;
  meshadapt::Carrying carrying;
};

/// Returns the vectors on the mesh `after`, which has no overlap; the caller owns them. Throws
/// Error, on all ranks. Collective.
std::vector<Vec> carry_vectors(const Communicator& comm, const runtime::Executor& executor,
                               DM before, const std::vector<CarriedVector>& vectors, DM after);

/// Transfers the vectors composed with `before` under the names in -dm_ductile_fields and
/// -dm_ductile_cell_fields, by value if in -dm_ductile_by_value, and composes the results with
/// `after`. Also composes the target metric as "ductile_metric": a tensor for each vertex, row by
/// row. Throws Error, on all ranks. Collective.
void compose_vectors(const Communicator& comm, const runtime::Executor& executor, DM before,
                     const AdaptedParts& parts, DM after);

}  // namespace ductile::petsc
