/// @file
/// What is done to a random body before it is adapted: it gets regions and a place in space, its
/// facets are listed, and some of it is required.
#pragma once

#include <cstdint>

#include "mesh.hpp"
#include "random.hpp"

namespace ductile::campaign {

/// Regions by half spaces, by the nearest of some points or at random, unless it has some already.
void choose_regions(Random& random, Mesh& mesh);

// ---- Places. Each returns by what lengths were multiplied. ----

double put_turned(Random& random, Mesh& mesh);    ///< turned, the same size
double put_far_away(Random& random, Mesh& mesh);  ///< scaled by up to 1e20 and moved by up to 1e8

/// Turned, and written with few digits; `exact` gets the same before that. `rounding` is how far
/// vertices moved at most, 0 if nothing was rounded because elements would have been turned.
double put_with_few_digits(Random& random, Mesh& mesh, Mesh& exact, double& rounding);

// ---- What is listed ----

/// Boundary and, mostly, interfaces; references are of one kind out of several.
void list_all_facets(std::uint64_t seed, Mesh& mesh);
void unlist_some(Random& random, Mesh& mesh);   ///< takes a part of the boundary from the list
void require_some(Random& random, Mesh& mesh);  ///< vertices, edges, facets, elements, corners

}  // namespace ductile::campaign
