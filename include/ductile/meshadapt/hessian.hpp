/// @file
/// First and second derivatives, at the vertices, of a field that is known there only: what an
/// adaptation to a solution starts from. Results do not depend on the number of threads.
#pragma once

#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

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
/// hessian_metric.hpp). A direction in which the mesh is too coarse to tell gets 0.
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

}  // namespace ductile::meshadapt
