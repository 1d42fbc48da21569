/// @file
/// RandomCase: a random mesh and metric to adapt it to, some of them nasty, made from a seed alone.
#pragma once

#include <string>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt::test {

struct RandomCase {
  AnyMesh mesh;
  AnyField metric;
  AdaptOptions options;
  std::string what;  ///< in words
};

/// The case of this seed: even seeds are 2D, odd ones 3D. Shapes, regions, required entities,
/// slivers, places in space, kinds of metric and options all vary. The metric asks for at most
/// about 10,000 elements.
RandomCase random_case(std::uint64_t seed);

}  // namespace ductile::meshadapt::test
