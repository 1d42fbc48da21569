/// @file
/// Topology of a mesh as numbers that adaptation must not change: Euler characteristics, connected
/// parts of regions and of the boundary, and where the boundary touches itself.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mesh.hpp"

namespace ductile::campaign {

struct PartTopology {
  int euler = 0;                ///< of the elements, including their facets, edges and vertices
  int components = 0;           ///< parts of the elements, connected by facets
  int boundary_components = 0;  ///< parts of the boundary facets, connected by vertices
  int boundary_euler = 0;       ///< of the boundary facets, including their edges and vertices

  friend bool operator==(const PartTopology&, const PartTopology&) = default;
};

struct Topology {
  PartTopology whole;
  std::map<int, PartTopology> by_region;
  int non_manifold_vertices = 0;  ///< elements not connected by facets; off those lines
  int non_manifold_lines = 0;  ///< connected parts of edges with more than two boundary facets (3D)
};

Topology topology_of(const Mesh& mesh);

/// The differences, one line each.
std::vector<std::string> differences(const Topology& before, const Topology& after);

}  // namespace ductile::campaign
