/// @file
/// The metric that minimises the error of linear interpolation of a function for a given number of
/// elements, from its second derivatives: Loseille & Alauzet, "Continuous mesh framework" I and II,
/// SIAM J. Numer. Anal. 49 (2011). In the L^p norm it is
///   M = C det|H|^(-1/(2p+d)) |H|,
/// with one constant C for the whole mesh, found here with the bounds on sizes applied.
#pragma once

#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

// ---- Derivatives of functions known at vertices ----

enum class Recovery {
  /// Fits a quadratic through the vertex to the values around it by least squares, weighted by
  /// inverse distance. Distances are scaled by the shape of the surroundings, so that it works as
  /// well on stretched meshes. The surroundings grow from the elements around the vertex until they
  /// determine a quadratic; at the boundary they are a layer wider. Exact for quadratics on any
  /// mesh.
  least_squares,
  /// Projects the gradients of the elements to the vertices (L2, lumped mass), and differentiates
  /// the result the same way. At the boundary, where both are one-sided, gradients are extrapolated
  /// linearly from interior vertices, and second derivatives are averages of interior ones. Faster
  /// and smoother; exact for quadratics on locally symmetric meshes.
  double_projection,
};

/// Gradients at the vertices. Throws InputError unless there is a value for each vertex. Thread
/// safety of this and the following: one caller; runs on the executor.
template <int Dim>
std::vector<Vector<Dim>> recover_gradient(const runtime::Executor& executor,
                                          const FixedMesh<Dim>& mesh,
                                          std::span<const double> value_of,
                                          Recovery recovery = Recovery::least_squares);

/// The same by least squares at these vertices alone: [index in `at`].
template <int Dim>
std::vector<Vector<Dim>> recover_gradient_at(const runtime::Executor& executor,
                                             const FixedMesh<Dim>& mesh,
                                             std::span<const double> value_of,
                                             std::span<const VertexId> at);

/// Second derivatives at the vertices: symmetric tensors, in general not metrics (see
/// hessian_metric()). 0 in directions in which the mesh is too coarse to tell.
template <int Dim>
std::vector<Metric<Dim>> recover_hessian(const runtime::Executor& executor,
                                         const FixedMesh<Dim>& mesh,
                                         std::span<const double> value_of,
                                         Recovery recovery = Recovery::least_squares);

/// The same for every component of every field: one symmetric field for each, in order.
AnyField recover_hessian(const runtime::Executor& executor, const AnyMesh& mesh,
                         const AnyField& field, Recovery recovery = Recovery::least_squares);

extern template std::vector<Vector<2>> recover_gradient(const runtime::Executor&,
                                                        const FixedMesh<2>&,
                                                        std::span<const double>, Recovery);
extern template std::vector<Vector<3>> recover_gradient(const runtime::Executor&,
                                                        const FixedMesh<3>&,
                                                        std::span<const double>, Recovery);
extern template std::vector<Vector<2>> recover_gradient_at(const runtime::Executor&,
                                                           const FixedMesh<2>&,
                                                           std::span<const double>,
                                                           std::span<const VertexId>);
extern template std::vector<Vector<3>> recover_gradient_at(const runtime::Executor&,
                                                           const FixedMesh<3>&,
                                                           std::span<const double>,
                                                           std::span<const VertexId>);
extern template std::vector<Metric<2>> recover_hessian(const runtime::Executor&,
                                                       const FixedMesh<2>&, std::span<const double>,
                                                       Recovery);
extern template std::vector<Metric<3>> recover_hessian(const runtime::Executor&,
                                                       const FixedMesh<3>&, std::span<const double>,
                                                       Recovery);

// ---- Complexity: the integral of sqrt(det metric), proportional to the elements of a unit mesh
// ----

/// The integral over the mesh of sqrt(det metric), linear in each element; MeshStatistics has the
/// same figure. On a surface the determinant is that in the plane of each triangle. Thread safety
/// of this and the following: one caller; runs on the executor.
template <int Dim, int Space>
double complexity(const runtime::Executor& executor, const FixedMesh<Dim, Space>& mesh,
                  const std::vector<Metric<Space>>& metric_of);

/// The complexity of a metric for which an adapted mesh has about this many elements: 2.25
/// triangles or 9.5 tetrahedra per unit of complexity, within 10 %, measured on varying metrics.
/// Regular elements with edges of length 1, which cannot fill space in 3D, would give 2.31
/// and 8.49.
double complexity_of_elements(int dimension, double elements);

/// What to reach, either `complexity` or `elements`, and the bounds on sizes.
struct ComplexityGoal {
  double complexity = 0;
  SizeBounds bounds = {};  ///< the scaled metric keeps within them
  double gradation = 0;    ///< sizes grow by at most this factor per unit of metric length (see
                           ///< limit_gradation); 0 or less: no limit
  /// About how many elements an adapted mesh will have. A tetrahedral mesh that is adapted to
  /// nearly these metrics already, as in a loop, tells by its own elements how many come per unit
  /// of complexity; otherwise complexity_of_elements() does.
  double elements = 0;
};

/// How close a metric is to its goal.
struct MetricFit {
  double complexity = 0;  ///< of the metric
  double elements = 0;    ///< about how many an adapted mesh will have
  double error = 0;       ///< its interpolation error, see FittedMetric; 0 if unknown
  bool reached = false;   ///< false: the bounds on sizes make the goal impossible
};

/// Scales all metrics by one factor and bounds them, so that the complexity is the wanted one, or
/// as close as the bounds allow. With a gradation, also grades them; the complexity after that is
/// within 2 % of the wanted one. Throws InputError unless one goal is above 0 and the other 0, if
/// bounds or gradation are out of range, or if there is not a metric for each vertex.
template <int Dim, int Space>
MetricFit scale_to_complexity(const runtime::Executor& executor,
                              std::vector<Metric<Space>>& metric_of,
                              const FixedMesh<Dim, Space>& mesh, const ComplexityGoal& goal);

extern template double complexity(const runtime::Executor&, const FixedMesh<2>&,
                                  const std::vector<Metric<2>>&);
extern template double complexity(const runtime::Executor&, const FixedMesh<2, 3>&,
                                  const std::vector<Metric<3>>&);
extern template double complexity(const runtime::Executor&, const FixedMesh<3>&,
                                  const std::vector<Metric<3>>&);
extern template MetricFit scale_to_complexity(const runtime::Executor&, std::vector<Metric<2>>&,
                                              const FixedMesh<2>&, const ComplexityGoal&);
extern template MetricFit scale_to_complexity(const runtime::Executor&, std::vector<Metric<3>>&,
                                              const FixedMesh<2, 3>&, const ComplexityGoal&);
extern template MetricFit scale_to_complexity(const runtime::Executor&, std::vector<Metric<3>>&,
                                              const FixedMesh<3>&, const ComplexityGoal&);

// ---- The metric of second derivatives ----

/// The goal of the metric: one of `complexity`, `elements` and `error` is above 0.
struct HessianMetricOptions {
  double norm = 2;         ///< p, at least 1, or infinity. A small p also resolves weak features
  double complexity = 0;   ///< see ComplexityGoal
  double elements = 0;     ///< see ComplexityGoal
  double error = 0;        ///< the interpolation error in this norm, estimated as below
  SizeBounds bounds = {};  ///< largest size, if not given: the mesh's extent; anisotropy: 30
};

/// A metric at each vertex, and how close it is to the goal. The error is the L^p norm of
/// trace(M^-1 |H|) / (4 (d + 2)), which for a mesh of unit elements is the mean over each element
/// of its interpolation error.
template <int Dim>
struct FittedMetric {
  std::vector<Metric<Dim>> metric_of;  // [vertex]
  MetricFit fit;
};

/// hessian_of[vertex] need not be definite: the absolute values of its eigenvalues are used. Where
/// it is 0 everywhere around, elements get as large as the rest of the mesh and the bounds permit.
/// Throws InputError for options out of range, or unless there is a finite tensor for each vertex.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
FittedMetric<Dim> hessian_metric(const runtime::Executor& executor, const FixedMesh<Dim>& mesh,
                                 const std::vector<Metric<Dim>>& hessian_of,
                                 const HessianMetricOptions& options);

/// Options of solution_metric().
struct SolutionMetricOptions {
  HessianMetricOptions goal = {};
  double gradation = 0;  ///< as in ComplexityGoal: the complexity is that of the graded metric
  Recovery recovery = Recovery::least_squares;
};

/// The metric of a solution, and how close it is to the goal.
struct SolutionMetric {
  AnyField metric;  ///< one symmetric field, as adapt() takes it
  MetricFit fit;
};

/// Computes in one call the metric for every component of every field at the vertices of the mesh.
/// Each component gives a metric from its Hessian, taken as 0 if the component is linear up to
/// rounding; they are intersected, graded if wanted, and scaled once more unless the goal is an
/// error. A goal of error applies to each component before grading. The reported error is the
/// largest, for the metric returned. On a surface, derivatives are those in its tangent planes, by
/// least squares alone; ridges belong to the surfaces on both sides. Throws InputError as above, or
/// if the field is not of this mesh or has values that are not finite. Thread safety: one caller;
/// runs on the executor.
SolutionMetric solution_metric(const runtime::Executor& executor, const AnyMesh& mesh,
                               const AnyField& field, const SolutionMetricOptions& options);

extern template FittedMetric<2> hessian_metric(const runtime::Executor&, const FixedMesh<2>&,
                                               const std::vector<Metric<2>>&,
                                               const HessianMetricOptions&);
extern template FittedMetric<3> hessian_metric(const runtime::Executor&, const FixedMesh<3>&,
                                               const std::vector<Metric<3>>&,
                                               const HessianMetricOptions&);

}  // namespace ductile::meshadapt
