/// @file
/// gather_overlap: collects the parts of one distributed mesh that overlap those of another. Ranks
/// send each other the bounding boxes of their elements and receive the elements that intersect
/// them.
#pragma once

#include <vector>

#include "distributed/communicator.hpp"
#include "distributed/part.hpp"

namespace ductile::distributed {

/// A part of a mesh with fields.
struct PartWithFields {
  AnyMesh mesh;
  std::vector<meshadapt::NamedField> fields;
};

/// The elements of the parts `from`, with the values of fields there, that intersect boxes around
/// the elements of this rank's part `to`. They are in the order of the ranks, vertices in that of
/// their numbers, so the result is deterministic. Collective.
PartWithFields gather_overlap(const Communicator& comm, const Part& from,
                              const std::vector<meshadapt::NamedField>& fields, const Part& to);

}  // namespace ductile::distributed
