/// @file
/// psi (cases/psi.hpp) on a mesh: its values at the vertices, and how far linear elements are from
/// it.
#pragma once

#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::paper {

/// Values of psi at the vertices.
meshadapt::AnyField sampled_solution(const runtime::Executor& executor,
                                     const meshadapt::AnyMesh& mesh, double phase);

/// Norms of the difference between psi and its interpolant. No linear element can follow
/// the jump: in the elements that it cuts, the error does not shrink, only their volume does. L1
/// has the optimal rate even so, as long as that volume shrinks fast enough; L2 has it beside the
/// jump.
struct InterpolationError {
  double everywhere = 0;   ///< L1
  double beside_jump = 0;  ///< L2 over the elements that the jump does not cut
};

/// Evaluated at about 50 points in each element, so elements cut by the jump contribute with an
/// error of some per cent of their share.
template <int Dim>
InterpolationError interpolation_error(const runtime::Executor& executor,
                                       const meshadapt::AnyMesh& mesh, double phase);

extern template InterpolationError interpolation_error<2>(const runtime::Executor&,
                                                          const meshadapt::AnyMesh&, double);
extern template InterpolationError interpolation_error<3>(const runtime::Executor&,
                                                          const meshadapt::AnyMesh&, double);

}  // namespace ductile::paper
