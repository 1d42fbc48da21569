/// @file
/// level_set_gradients: gradients of a function near its zero, by cubics fitted to two layers of
/// vertices: with quadratics a ball that is a few elements wide grows each time it is cut anew.
#pragma once

#include <span>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// [index in `at`]: at these vertices, by cubics, or as recover_gradient() where the vertices
/// around determine none. There is a value for each vertex. Thread safety: one caller; runs on the
/// executor.
template <int Dim>
std::vector<Vector<Dim>> level_set_gradients(const runtime::Executor& executor,
                                             const FixedMesh<Dim>& mesh,
                                             std::span<const double> value_of,
                                             std::span<const VertexId> at);

}  // namespace ductile::meshadapt
