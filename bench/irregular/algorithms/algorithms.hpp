/// @file
/// One function for each file of this folder; each returns a row of the suite.
#pragma once

#include "suite.hpp"

namespace ductile::bench::irregular {

Algorithm core_numbers();
Algorithm delaunay_flips();
Algorithm delaunay_insertion();
Algorithm delaunay_refinement();
Algorithm independent_set();
Algorithm matching();
Algorithm minimum_degree();
Algorithm shortest_paths();
Algorithm spanning_forest();
Algorithm spanning_tree();

}  // namespace ductile::bench::irregular
