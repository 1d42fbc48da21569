/// @file
/// transfer_parts: carries fields from one distributed mesh to another of the same domain, whose
/// parts are elsewhere. Each rank gets what its new part overlaps, and does what transfer_fields()
/// does; sums at vertices that parts share are made over all of them.
#pragma once

#include <vector>

#include "communicator.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/executor.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// A part with fields; it refers to both.
struct FieldsOnPart {
  const Part& part;
  const std::vector<meshadapt::NamedField>& fields;
};

/// The fields at the vertices and on the elements of the part `to`, whose vertices are numbered
/// and that lists its boundary. The order and kinds of fields are the same on all ranks, those of
/// an empty part have no values. One way of carrying, or one for each. Integrals over all ranks
/// are kept as transfer_fields() keeps them. Throws as that does, as Error on all ranks.
/// Collective.
std::vector<meshadapt::NamedField> transfer_parts(const Communicator& comm,
                                                  const runtime::Executor& executor,
                                                  const FieldsOnPart& from, const Part& to,
                                                  const std::vector<meshadapt::Carrying>& carrying);

}  // namespace ductile::petsc
