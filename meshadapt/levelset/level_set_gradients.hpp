/// @file
/// level_set_gradients: gradients of a function known at the vertices of a mesh, most accurate near
/// its zero. There they are those of cubics fitted to two layers of vertices by least squares:
/// quadratics make a ball of a few elements grow by a part in a thousand each time it is cut anew.
#pragma once

#include <span>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// [vertex]. Cubics at the corners of elements in which the values have both signs, where the
/// vertices around determine one; elsewhere as recover_gradient(). There is a value for each
/// vertex. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<Vector<Dim>> level_set_gradients(const runtime::Executor& executor,
                                             const FixedMesh<Dim>& mesh,
                                             std::span<const double> value_of);

extern template std::vector<Vector<2>> level_set_gradients(const runtime::Executor&,
                                                           const FixedMesh<2>&,
                                                           std::span<const double>);
extern template std::vector<Vector<3>> level_set_gradients(const runtime::Executor&,
                                                           const FixedMesh<3>&,
                                                           std::span<const double>);

}  // namespace ductile::meshadapt
