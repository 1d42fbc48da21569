/// @file
/// ShortEdgeCase: a mesh with a required edge, or required facets, far shorter than the requested
/// size, made from a seed alone.
#pragma once

#include <cstdint>
#include <string>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt::test {

struct ShortEdgeCase {
  AnyMesh mesh;
  AnyField metric;
  std::string what;  ///< in words
};

/// The unit square or cube, its bottom required, where one to three edges are 1e-2 to 1e-6 times as
/// long as others. Sizes are about those of the other edges, the same everywhere. Every required
/// edge is shorter than the longest that is allowed.
ShortEdgeCase short_edge_case(int dimension, std::uint64_t seed);

}  // namespace ductile::meshadapt::test
