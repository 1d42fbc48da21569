/// @file
/// Complexity: the integral of sqrt(det metric), which is what a mesh of unit elements needs of
/// them; and metrics scaled so that it becomes what is wanted, with bounds on sizes in force.
#pragma once

#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// The integral over the mesh of sqrt(det metric), linear in each element. The same figure as
/// MeshStatistics has. Thread safety: one caller; runs on the executor. So does what follows.
template <int Dim>
double complexity(const runtime::Executor& executor, const FixedMesh<Dim>& mesh,
                  const std::vector<Metric<Dim>>& metric_of);

/// The complexity of a metric to which an adapted mesh has about this many elements: 2.35 triangles
/// or 11 tetrahedra per unit of complexity, give or take 10 %, as measured on metrics that vary.
/// Regular elements with edges of length 1, which fill no space in 3D, would be 2.31 and 8.49.
double complexity_of_elements(int dimension, double elements);

/// The complexity to reach, and the bounds on sizes that hold meanwhile.
struct ComplexityGoal {
  double complexity = 0;
  SizeBounds bounds = {};  ///< the scaled metric keeps within them
  double gradation = 0;    ///< sizes grow by at most this factor per unit of metric length (see
                           ///< limit_gradation); 0 or less: however fast they do
};

/// How far a metric got in being what was asked for.
struct MetricFit {
  double complexity = 0;  ///< of the metric
  double error = 0;       ///< its interpolation error, see hessian_metric.hpp; 0 if not known
  bool reached = false;   ///< false: the bounds on sizes leave no metric that is what was asked for
};

/// Multiplies all metrics by one factor and bounds them, so that the complexity is the one wanted,
/// or as near to it as the bounds let it be. With a gradation, the metrics are graded as well, and
/// scaled so that the complexity afterwards is the one wanted, within 2 %. Throws InputError if the
/// goal is not above 0, bounds or gradation are out of range, or there is not a metric for each
/// vertex.
template <int Dim>
MetricFit scale_to_complexity(const runtime::Executor& executor,
                              std::vector<Metric<Dim>>& metric_of, const FixedMesh<Dim>& mesh,
                              const ComplexityGoal& goal);

extern template double complexity(const runtime::Executor&, const FixedMesh<2>&,
                                  const std::vector<Metric<2>>&);
extern template double complexity(const runtime::Executor&, const FixedMesh<3>&,
                                  const std::vector<Metric<3>>&);
extern template MetricFit scale_to_complexity(const runtime::Executor&, std::vector<Metric<2>>&,
                                              const FixedMesh<2>&, const ComplexityGoal&);
extern template MetricFit scale_to_complexity(const runtime::Executor&, std::vector<Metric<3>>&,
                                              const FixedMesh<3>&, const ComplexityGoal&);

}  // namespace ductile::meshadapt
