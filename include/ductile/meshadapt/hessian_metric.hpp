/// @file
/// The metric in which linear interpolation of a function has the smallest error that a number of
/// elements allows, from the function's second derivatives: Loseille & Alauzet, "Continuous mesh
/// framework" I and II, SIAM J. Numer. Anal. 49 (2011). In the L^p norm it is
///   M = C det|H|^(-1/(2p+d)) |H|,
/// with one constant C for the whole mesh, here found with the bounds on sizes in force.
#pragma once

#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

// ---- Derivatives of what is known at the vertices only ----

enum class Recovery {
  /// A quadratic through the vertex, closest to the values around it in the sense of least squares,
  /// weighted by the inverse distance. Distances are those in the shape of the surroundings, so
  /// that stretched meshes are as good as others. Surroundings grow, from the elements around the
  /// vertex, until they determine a quadratic; at the boundary they are a layer wider. Exact for
  /// quadratics on any mesh.
  least_squares,
  /// The gradients of the elements, projected to the vertices (L2, lumped mass), and those of the
  /// result once more. At the boundary, where both are one-sided, gradients are extrapolated
  /// linearly from vertices inside, and second derivatives are the mean of those inside. Faster and
  /// smoother; exact for quadratics where the mesh is alike on all sides.
  double_projection,
};

/// Gradients at the vertices. Throws InputError unless there is a value for each vertex.
/// Thread safety: one caller; runs on the executor. So does what follows.
template <int Dim>
std::vector<Vector<Dim>> recover_gradient(const runtime::Executor& executor,
                                          const FixedMesh<Dim>& mesh,
                                          std::span<const double> value_of,
                                          Recovery recovery = Recovery::least_squares);

/// Second derivatives at the vertices: symmetric tensors, most of them no metrics (see
/// hessian_metric()). A direction in which the mesh is too coarse to tell gets 0.
template <int Dim>
std::vector<Metric<Dim>> recover_hessian(const runtime::Executor& executor,
                                         const FixedMesh<Dim>& mesh,
                                         std::span<const double> value_of,
                                         Recovery recovery = Recovery::least_squares);

/// The same of every component of every field: one symmetric field for each, in their order.
AnyField recover_hessian(const runtime::Executor& executor, const AnyMesh& mesh,
                         const AnyField& field, Recovery recovery = Recovery::least_squares);

extern template std::vector<Vector<2>> recover_gradient(const runtime::Executor&,
                                                        const FixedMesh<2>&,
                                                        std::span<const double>, Recovery);
extern template std::vector<Vector<3>> recover_gradient(const runtime::Executor&,
                                                        const FixedMesh<3>&,
                                                        std::span<const double>, Recovery);
extern template std::vector<Metric<2>> recover_hessian(const runtime::Executor&,
                                                       const FixedMesh<2>&, std::span<const double>,
                                                       Recovery);
extern template std::vector<Metric<3>> recover_hessian(const runtime::Executor&,
                                                       const FixedMesh<3>&, std::span<const double>,
                                                       Recovery);

// ---- Complexity: the integral of sqrt(det metric), by which a mesh of unit elements grows ----

/// The integral over the mesh of sqrt(det metric), linear in each element. The same figure as
/// MeshStatistics has. Thread safety: one caller; runs on the executor. So does what follows.
template <int Dim>
double complexity(const runtime::Executor& executor, const FixedMesh<Dim>& mesh,
                  const std::vector<Metric<Dim>>& metric_of);

/// The complexity of a metric to which an adapted mesh has about this many elements: 2.25 triangles
/// or 9.5 tetrahedra per unit of complexity, give or take 10 %, as measured on metrics that vary.
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
  double error = 0;       ///< its interpolation error, see FittedMetric; 0 if not known
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

// ---- The metric of second derivatives ----

/// What the metric is to reach: either of `complexity` and `error` is above 0.
struct HessianMetricOptions {
  double norm = 2;  ///< p, at least 1; infinity is one too. Small p resolve weak features, too
  double complexity = 0;   ///< see complexity_of_elements
  double error = 0;        ///< the interpolation error in this norm, estimated as below
  SizeBounds bounds = {};  ///< largest size, if not given: the mesh's extent; anisotropy: 30
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
