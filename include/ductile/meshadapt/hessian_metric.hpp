/// @file
/// The metric in which linear interpolation of a function has the smallest error that a number of
/// elements allows, from the function's second derivatives: Loseille & Alauzet, "Continuous mesh
/// framework" I and II, SIAM J. Numer. Anal. 49 (2011). In the L^p norm it is
///   M = C det|H|^(-1/(2p+d)) |H|,
/// with one constant C for the whole mesh, here found with the bounds on sizes in force.
#pragma once

#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/complexity.hpp"
#include "ductile/meshadapt/hessian.hpp"

namespace ductile::meshadapt {

/// What the metric is to reach: either of `complexity` and `error` is above 0.
struct HessianMetricOptions {
  double norm = 2;  ///< p, at least 1; infinity is one too. Small p resolve weak features, too
  double complexity = 0;   ///< see complexity_of_elements
  double error = 0;        ///< the interpolation error in this norm, estimated as below
  SizeBounds bounds = {};  ///< largest size, if not given: the mesh's extent; anisotropy: 1e6
};

/// A metric at each vertex, and how near it came to what was asked for. The error is the L^p norm
/// of trace(M^-1 |H|) / (4 (d + 2)), which for a mesh of unit elements is the mean over each
/// element of its interpolation error.
template <int Dim>
struct FittedMetric {
  std::vector<Metric<Dim>> metric_of;  // [vertex]
  MetricFit fit;
};

/// hessian_of[vertex] need not be definite: the absolute values of its eigenvalues count. Where all
/// of it is 0, elements get as large as the rest of the mesh and the bounds permit. Throws
/// InputError for options out of range, or unless there is a finite tensor for each vertex.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
FittedMetric<Dim> hessian_metric(const runtime::Executor& executor, const FixedMesh<Dim>& mesh,
                                 const std::vector<Metric<Dim>>& hessian_of,
                                 const HessianMetricOptions& options);

/// What the metric of a solution is to reach.
struct SolutionMetricOptions {
  HessianMetricOptions goal = {};
  double gradation = 0;  ///< as in ComplexityGoal: the complexity is that of the graded metric
  Recovery recovery = Recovery::least_squares;
};

/// The metric of a solution, and what it asks for.
struct SolutionMetric {
  AnyField metric;  ///< one symmetric field, as adapt() takes it
  MetricFit fit;
};

/// All in one: the metric that suits every component of every field at the vertices of the mesh.
/// Each gets a metric from its Hessian, which counts as 0 where the component is linear everywhere
/// but for rounding; they are intersected, graded if wanted, and with a
/// complexity as the goal scaled to it once more. With an error as the goal, it is that of each
/// before grading. The error reported is the largest, of the metric returned. Throws InputError as
/// above, or if the field is not of this mesh or has values that are not finite.
/// Thread safety: one caller; runs on the executor.
SolutionMetric solution_metric(const runtime::Executor& executor, const AnyMesh& mesh,
                               const AnyField& field, const SolutionMetricOptions& options);

extern template FittedMetric<2> hessian_metric(const runtime::Executor&, const FixedMesh<2>&,
                                               const std::vector<Metric<2>>&,
                                               const HessianMetricOptions&);
extern template FittedMetric<3> hessian_metric(const runtime::Executor&, const FixedMesh<3>&,
                                               const std::vector<Metric<3>>&,
                                               const HessianMetricOptions&);

}  // namespace ductile::meshadapt
