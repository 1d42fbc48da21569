/// @file
/// Metrics as formulas on the unit square and cube, each scaled to a complexity: about 2.25
/// triangles or 9.5 tetrahedra of an adapted mesh per unit of it.
#pragma once

#include <functional>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::bench {

/// The metric at a place. Thread safety: any thread.
template <int Dim>
using Formula = std::function<meshadapt::Metric<Dim>(const meshadapt::Vector<Dim>&)>;

/// The metric of complexity `complexity` in which linear elements follow psi at time 0 best in L2:
/// factor det(|H|)^(-1/(4 + Dim)) |H| of the Hessian H (Alauzet & Loseille, J. Comput. Phys. 229,
/// 2010). Eigenvalues of |H| below 0.01 count as that, sizes are kept from 1e-5 to 0.3. In space
/// nothing changes along z.
template <int Dim>
Formula<Dim> psi_metric(const runtime::Executor& executor, double complexity);

/// Edges of length `size` in all directions.
template <int Dim>
Formula<Dim> uniform_metric(double size);

// ---- Metrics of the unstructured grid adaptation working group (Ibanez et al., Procedia Eng. 203,
// 2017) ----

/// A circle of radius 1/4 around the middle of the square: sizes across it grow linearly with the
/// distance from it, 0.001 to 0.1, and are 0.1 along it.
meshadapt::Metric<2> circle_metric(const meshadapt::Vector<2>& place);

/// A boundary layer at y = 0: 1 : 1000 there, sizes of 0.01 from y = 0.05 on.
meshadapt::Metric<2> boundary_metric(const meshadapt::Vector<2>& place);

/// A layer at z = 1/2: sizes along z grow linearly with the distance from it, 0.001 to 0.1, and are
/// 0.1 along x and y.
meshadapt::Metric<3> cube_linear_metric(const meshadapt::Vector<3>& place);

// ---- Directions that turn, sizes that stay ----

/// 0.004 in a direction that turns by 1.5 x + 0.5 y, 0.1 across it.
meshadapt::Metric<2> turning_metric(const meshadapt::Vector<2>& place);

/// 0.01 in a direction that turns about two axes, 0.25 across it.
meshadapt::Metric<3> turning_metric(const meshadapt::Vector<3>& place);

// ---- Growth ----

/// A gently curved layer in the middle of the cube: across it, sizes are 1 : 100 of those along it,
/// and grow linearly with the distance until they are the same.
Formula<3> curved_layer_metric(const runtime::Executor& executor, double complexity);

/// The formula with its tensors multiplied by `factor`, which multiplies the complexity by
/// factor^(Dim / 2).
template <int Dim>
Formula<Dim> scaled(Formula<Dim> formula, double factor);

/// The formula at the vertices: one symmetric field.
template <int Dim>
meshadapt::AnyField sampled_metric(const runtime::Executor& executor,
                                   const meshadapt::AnyMesh& mesh, const Formula<Dim>& formula);

extern template Formula<2> psi_metric<2>(const runtime::Executor&, double);
extern template Formula<3> psi_metric<3>(const runtime::Executor&, double);
extern template Formula<2> uniform_metric<2>(double);
extern template Formula<3> uniform_metric<3>(double);
extern template Formula<2> scaled<2>(Formula<2>, double);
extern template Formula<3> scaled<3>(Formula<3>, double);
extern template meshadapt::AnyField sampled_metric<2>(const runtime::Executor&,
                                                      const meshadapt::AnyMesh&, const Formula<2>&);
extern template meshadapt::AnyField sampled_metric<3>(const runtime::Executor&,
                                                      const meshadapt::AnyMesh&, const Formula<3>&);

}  // namespace ductile::bench
