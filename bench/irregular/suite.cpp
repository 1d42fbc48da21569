#include "suite.hpp"

#include "algorithms/algorithms.hpp"

namespace ductile::bench::irregular {

std::vector<Algorithm> algorithms() {
  return {independent_set(),     matching(),          spanning_forest(), spanning_tree(),
          core_numbers(),        shortest_paths(),    minimum_degree(),  delaunay_flips(),
          delaunay_refinement(), delaunay_insertion()};
}

}  // namespace ductile::bench::irregular
