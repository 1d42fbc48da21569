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

/// Of all elements and, if there are several references, of the elements of each, by reference.
/// Nearly linear in the mesh. Precondition: indices are in range.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<RegionTopology> topology_of(const AdjacentMesh<Dim>& mesh);

/// How the topology of `after` differs from that of `before`, a line for each region and number;
/// empty if it does not. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<std::string> topology_faults(const AdjacentMesh<Dim>& before,
                                         const AdjacentMesh<Dim>& after);

extern template std::vector<RegionTopology> topology_of(const AdjacentMesh<2>&);
extern template std::vector<RegionTopology> topology_of(const AdjacentMesh<3>&);
extern template std::vector<std::string> topology_faults(const AdjacentMesh<2>&,
                                                         const AdjacentMesh<2>&);
extern template std::vector<std::string> topology_faults(const AdjacentMesh<3>&,
                                                         const AdjacentMesh<3>&);

}  // namespace ductile::meshadapt
