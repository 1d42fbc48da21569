/// @file
/// refine_to_level_set: refines a mesh where the zero of a function is, as far as needed to cut it
/// there: until the function's linear interpolant is 0 where the function is, and films that are
/// thinner than an element are resolved.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Values of a function at points, coordinates[point * dimension + axis]; called on the thread that
/// called adapt(). LevelSetFunction::at() is one where a function is known at vertices only. The
/// same points must give the same values.
using PointFunction = std::function<std::vector<double>(std::span<const double> coordinates)>;

struct LevelSetSizesOptions {
  /// Largest distance between the zeros of the function and of its linear interpolant, a length.
  double tolerance = 0;
  double smallest_size = 0;  ///< edges are not divided below this; 0: the tolerance
  int most_passes = 10;      ///< adaptations of the mesh, one after another
  AdaptOptions adapt = {};   ///< of each
};

/// Adapts the mesh to the metric, made finer at edges where the zero is not resolved, again and
/// again: where the value in the middle of an edge shows that the zero is off by more than the
/// tolerance, or that there is one between ends of the same sign. Returns the mesh as it is if all
/// is resolved there, and ends when it is, or after the most passes, with a warning if it is off by
/// more than two tolerances. Edges of the
/// smallest size count as resolved: at kinks, and where the gradient is 0, no size would be small
/// enough. Elsewhere a cut at the zero is then within the tolerance of the function, as adapt()
/// needs it to hold a Hausdorff tolerance against LevelSetFunction::surface(). Throws
/// InputError for options out of range and for values that are missing or not finite, and as
/// adapt() does; exceptions of the function leave it.
AdaptedMesh refine_to_level_set(const runtime::Executor& executor, const AnyMesh& mesh,
                                const AnyField& metric, const PointFunction& function,
                                const LevelSetSizesOptions& options);

}  // namespace ductile::meshadapt
