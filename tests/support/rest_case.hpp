/// @file
/// RestCase: a random mesh and a metric given by a formula, to adapt again and again.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt::test {

struct RestCase {
  AnyMesh mesh;
  std::function<AnyField(const AnyMesh&)> metric_on;  ///< evaluates the formula on a mesh
  AdaptOptions options;
  std::string what;  ///< in words
};

/// The case of this seed: even seeds are 2D, odd ones 3D. Shapes, regions, required entities,
/// curved boundaries, kinds of metric and options vary; metrics are isotropic or not, uniform or
/// not, and scaled to ask for about 50 to 3,000 elements.
RestCase rest_case(std::uint64_t seed);

}  // namespace ductile::meshadapt::test
