/// @file
/// LevelSetFunction: a function known at the vertices of a mesh, between them by its values and
/// gradients, and the smooth surface where it is 0. In an element it is
///   f(x) = sum of w_i (phi_i + g_i . (x - x_i) / 2)
/// over the corners, with barycentric weights w and recovered gradients g: continuous, and exact
/// for quadratics.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

template <int Dim>
class QuadraticBlend;  // levelset/quadratic_blend.hpp

/// See the top of this file. Copies share their data. Thread safety: any thread.
class LevelSetFunction {
 public:
  /// The function with these values at the vertices, minus `level`. Copies what it needs. Throws
  /// InputError unless the mesh is valid (see make_fixed_mesh) and there is a finite value for each
  /// vertex. Runs on the executor.
  LevelSetFunction(const runtime::Executor& executor, const AnyMesh& mesh,
                   std::span<const double> values, double level = 0);

  /// Values at points, coordinates[point * dimension + axis]; outside of the mesh those of the
  /// closest element, extended. Throws InputError unless there are `dimension` coordinates for
  /// each. Runs on the executor.
  std::vector<double> at(const runtime::Executor& executor,
                         std::span<const double> coordinates) const;

  /// The surface where the function is 0, for the facets with this reference; the closest point is
  /// found by Newton's method. It is unknown where the surface is farther away than `within`, or
  /// the method does not converge: see SurfaceFunction::approximate. Its sizes are those of chords
  /// that stay within 0.4 `within` of it, 2D: 0.25, because their distances add up to a volume.
  SurfaceFunction surface(std::int32_t reference, double within) const;

 private:
  std::shared_ptr<const QuadraticBlend<2>> plane_;  // null in 3D
  std::shared_ptr<const QuadraticBlend<3>> space_;  // null in 2D
};

}  // namespace ductile::meshadapt
