/// @file
/// Random metrics on a mesh: sizes and tensors of many kinds, scaled to between some tens and some
/// thousands of elements.
#pragma once

#include <string>
#include <vector>

#include "mesh.hpp"
#include "random.hpp"

namespace ductile::campaign {

struct MetricCase {
  Field field;
  bool smooth = true;  ///< sizes grow slowly enough for any -hgrad
  double size = 1;     ///< about the edge length asked for: the geometric mean over the mesh
  /// The smallest size along an axis; -hmin may be close to it.
  double smallest = 1;
  bool unlimited = false;             ///< some sizes are infinite, so -hmax must be given
  std::vector<std::string> refusals;  ///< words of accepted refusals
};

/// A metric of any kind: sizes or tensors; constant, graded, turning, in layers, with jumps, noise.
MetricCase random_metric(Random& random, const Mesh& mesh);

/// Sizes that differ by up to, and sometimes exactly, 1e8.
MetricCase strong_metric(Random& random, const Mesh& mesh);

/// No limit on sizes at some or all vertices: eigenvalues 0, sizes 1e300 or infinite.
MetricCase unlimited_metric(Random& random, const Mesh& mesh);

/// One size everywhere.
MetricCase uniform_metric(Random& random, const Mesh& mesh);

}  // namespace ductile::campaign
