/// @file
/// Topology of a mesh: of how many parts its regions and their boundaries consist, and Euler
/// characteristics. Adaptation keeps all of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/adjacency.hpp"

namespace ductile::meshadapt {

/// Of the elements of one reference, or of all. Where the boundary does not meet itself, the Euler
/// characteristic of the region is half of that of its boundary in 3D, and in 2D twice the number
/// of its parts, less that of the boundary's.
struct RegionTopology {
  std::optional<std::int32_t> reference;  ///< none: all elements
  std::size_t parts = 0;                  ///< of its elements, which share vertices
  std::size_t boundary_parts = 0;         ///< of the facets around it, which share vertices
  std::size_t sheets = 0;                 ///< ... if the boundary is cut up where it meets itself
  std::int64_t euler = 0;                 ///< of the boundary
  std::int64_t euler_of_sheets = 0;       ///< of the boundary cut up
  friend bool operator==(const RegionTopology&, const RegionTopology&) = default;
};

/// How the topology of `after` differs from that of `before`, which has the same dimension: of all
/// elements and of the elements of each reference, a line for each region and number; empty if it
/// does not. Nearly linear in the meshes. Precondition: indices are in range.
/// Thread safety: one caller; runs on the executor.
std::vector<std::string> topology_faults(const AdjacentMesh& before, const AdjacentMesh& after);

}  // namespace ductile::meshadapt
