/// @file
/// transfer_parts: transfers fields between distributed meshes of the same domain with different
/// parts. Each rank receives what its new part overlaps and calls transfer_fields(); sums at shared
/// vertices include all parts.
#pragma once

#include <vector>

#include "distributed/communicator.hpp"
#include "distributed/part.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// A part with fields; it refers to both.
struct FieldsOnPart {
  const Part& part;
  const std::vector<meshadapt::NamedField>& fields;
};

/// Transfers fields to the vertices and elements of the part `to`, which has numbered vertices and
/// lists its boundary. Order and kinds of fields are the same on all ranks; fields of an empty part
/// have no values. `carrying` has one entry, or one for each field. Integrals over all ranks are
/// kept as in transfer_fields(). Throws as that does, as Error on all ranks. Collective.
std::vector<meshadapt::NamedField> transfer_parts(const Communicator& comm,
                                                  const runtime::Executor& executor,
                                                  const FieldsOnPart& from, const Part& to,
                                                  const std::vector<meshadapt::Carrying>& carrying);

}  // namespace ductile::distributed
