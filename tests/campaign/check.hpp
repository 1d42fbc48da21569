/// @file
/// The checker: returns the faults of an adapted mesh, one line each, beginning with the kind of
/// fault. It shares no code with the library, decides by exact signs where rounding could matter,
/// and needs only the meshes and the case's promise.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mesh.hpp"

namespace ductile::campaign {

/// Requirements on the adapted mesh. Lengths are in units of the mesh.
struct Promise {
  double tolerance = 0;  ///< largest distance that curved boundaries may move (-hausd); 0: fixed
  double rounding = 0;   ///< largest rounding error of the input's coordinates
  bool unlisted_boundary = false;  ///< unlisted boundary facets count as reference 0
  bool touching = false;           ///< vertices of the input may coincide
  double shortest_size = 0;        ///< bounds of the metric that is written; 0: none
  double largest_size = 0;
  double longest_edge = 0;  ///< metric length, of edges that are not required; 0: not checked
};

using Faults = std::vector<std::string>;

/// Adds "KIND: COUNT WHAT" to the faults if the count is not 0.
inline void report(const std::string& kind, std::size_t count, const std::string& what,
                   Faults& faults) {
  if (count > 0) faults.push_back(kind + ": " + std::to_string(count) + " " + what);
}

/// Is it a mesh: indices, volumes, facets, lists?
Faults check_structure(const Mesh& mesh, bool unlisted_boundary = false);

/// Is the domain the same: topology, areas and volumes by reference, boundary by reference?
Faults check_domain(const Mesh& before, const Mesh& after, const Promise& promise);

/// Do the old and new boundaries and interfaces lie within the tolerance of each other?
Faults check_surface(const Mesh& before, const Mesh& after, const Promise& promise);

/// Do elements overlap, or does the boundary cross itself?
Faults check_overlaps(const Mesh& mesh);

/// Are required entities and corners there, with their references, and still marked?
Faults check_required(const Mesh& before, const Mesh& after);

/// Is the metric positive definite up to rounding, and within its bounds? Are edges as short as
/// promised?
Faults check_metric(const Mesh& mesh, const Field& metric, const Promise& promise);

/// Runs all checks above; after a fault of structure, no others.
Faults check_all(const Mesh& before, const Mesh& after, const Promise& promise);

}  // namespace ductile::campaign
