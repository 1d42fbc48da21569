/// @file
/// partition_graph: PT-Scotch, made to give the same parts each time.
#pragma once

#include <cstdint>
#include <vector>

#include "communicator.hpp"

namespace ductile::petsc {

/// The elements of all ranks, numbered in the order of the ranks, and which are side by side.
struct ElementGraph {
  std::int64_t first = 0;               ///< the number of this rank's first element
  std::vector<std::int64_t> begin;      ///< [own element], into `neighbour`, and the end
  std::vector<std::int64_t> neighbour;  ///< numbers
};

/// As many parts as ranks, about equal by weight, [own element]; one may be empty. Throws Error on
/// all ranks if there are more elements than PT-Scotch's 32 bits count, or it fails. Collective.
std::vector<int> partition_graph(const Communicator& comm, const ElementGraph& graph,
                                 const std::vector<std::int64_t>& weight_of);

}  // namespace ductile::petsc
