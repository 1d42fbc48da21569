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
  int euler = 0;                ///< of the elements with all that bounds them
  int components = 0;           ///< of elements that are connected by facets
  int boundary_components = 0;  ///< of facets that are connected by vertices
  int boundary_euler = 0;       ///< of those facets with all that bounds them

  friend bool operator==(const PartTopology&, const PartTopology&) = default;
};

struct Topology {
  PartTopology whole;
  std::map<int, PartTopology> by_region;
  int non_manifold_vertices = 0;  ///< whose elements are not connected by facets, off those lines
  int non_manifold_lines = 0;  ///< connected parts of edges with more than two boundary facets (3D)
};

Topology topology_of(const Mesh& mesh);

/// The differences, one line each.
std::vector<std::string> differences(const Topology& before, const Topology& after);

}  // namespace ductile::campaign
