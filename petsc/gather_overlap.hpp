/// @file
/// gather_overlap: what of one distributed mesh lies where the parts of another are. Ranks tell
/// each other in which boxes their elements are, and get the elements that reach into these.
#pragma once

#include <vector>

#include "communicator.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// A part of a mesh with fields.
struct PartWithFields {
  AnyMesh mesh;
  std::vector<meshadapt::NamedField> fields;
};

/// Where elements are, as a few boxes: [box * 2 * dimension + axis], low corners before high ones.
/// None of an empty part.
std::vector<double> boxes_of(const Part& part);

/// The elements of the parts `from`, with the values of fields there, that reach into the boxes of
/// this rank. They come in the order of the ranks, their vertices in that of their numbers, so
/// that the same parts give the same. Collective.
PartWithFields gather_overlap(const Communicator& comm, const Part& from,
                              const std::vector<meshadapt::NamedField>& fields,
                              const std::vector<double>& boxes);

}  // namespace ductile::petsc
