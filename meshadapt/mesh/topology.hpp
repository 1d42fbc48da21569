/// @file
/// Topology of a mesh: numbers of connected parts of its regions and their boundaries, and Euler
/// characteristics. Adaptation keeps all of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/adjacency.hpp"

namespace ductile::meshadapt {

/// Topology of the elements of one reference, or of all. If the boundary does not touch itself, the
/// Euler characteristic of the region is half that of its boundary in 3D, and in 2D twice the
/// number of its parts minus that of the boundary's.
struct RegionTopology {
  std::optional<std::int32_t> reference;  ///< none: all elements
  std::size_t parts = 0;                  ///< connected by shared vertices
  std::size_t boundary_parts = 0;         ///< of the facets around it, connected by shared vertices
  std::size_t sheets = 0;                 ///< as boundary_parts, with the boundary cut where it
                                          ///< touches itself
  std::int64_t euler = 0;                 ///< of the boundary
  std::int64_t euler_of_sheets = 0;       ///< of the cut boundary
  friend bool operator==(const RegionTopology&, const RegionTopology&) = default;
};

/// Differences between the topologies of `after` and `before`, of the same dimension: a line for
/// each region and number, for all elements and for those of each reference; empty if there are
/// none. Nearly linear in the meshes. Precondition: indices are in range. Thread safety: one
/// caller; runs on the executor.
std::vector<std::string> topology_faults(const AdjacentMesh& before, const AdjacentMesh& after);

}  // namespace ductile::meshadapt
