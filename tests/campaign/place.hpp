/// @file
/// Prepares a random body for adaptation: gives it regions and a place in space, lists its facets,
/// and makes some entities required.
#pragma once

#include <cstdint>

#include "mesh.hpp"
#include "random.hpp"

namespace ductile::campaign {

/// Regions by half spaces, by the nearest of some points or at random, unless it has some already.
void choose_regions(Random& random, Mesh& mesh);

// ---- Places. Each returns the factor by which lengths were multiplied. ----

double put_turned(Random& random, Mesh& mesh);    ///< turned, the same size
double put_far_away(Random& random, Mesh& mesh);  ///< scaled by up to 1e20 and moved by up to 1e8

/// Turns the mesh and rounds it to few digits; `exact` gets it before rounding. `rounding` is the
/// largest distance a vertex moved; 0 if rounding would have inverted elements and was left out.
double put_with_few_digits(Random& random, Mesh& mesh, Mesh& exact, double& rounding);

// ---- Listed facets ----

/// Lists the boundary and, mostly, interfaces; chooses one of several kinds of references.
void list_all_facets(std::uint64_t seed, Mesh& mesh);
void unlist_some(Random& random, Mesh& mesh);   ///< takes a part of the boundary from the list
void require_some(Random& random, Mesh& mesh);  ///< vertices, edges, facets, elements, corners

}  // namespace ductile::campaign
