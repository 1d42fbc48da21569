/// @file
/// Elasticity<Dim>: the cantilever under its load, linear elements, a stiffness for each element;
/// plane stress in 2D. Made once for a mesh, solved for many distributions of stiffness.
#pragma once

#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "linear_solver.hpp"

namespace ductile::paper {

template <int Dim>
class Elasticity {
 public:
  /// Keeps a reference to `mesh`, the fixed form of `any`.
  Elasticity(const runtime::Executor& executor, const meshadapt::AnyMesh& any,
             const meshadapt::FixedMesh<Dim>& mesh, double poisson);

  struct Solution {
    double compliance = 0;                                  ///< force times displacement
    std::vector<meshadapt::Vector<Dim>> displacement_of{};  // [vertex]
  };
  /// stiffness_of[element] is Young's modulus. `guess` is where iterative solvers start: a
  /// displacement for each vertex, or empty. Thread safety: one thread.
  Solution solve(const std::vector<double>& stiffness_of,
                 const std::vector<meshadapt::Vector<Dim>>& guess);

  /// Twice the energy per volume that an element of stiffness 1 would hold, [element].
  std::vector<double> unit_energy(const std::vector<meshadapt::Vector<Dim>>& displacement_of) const;

 private:
  static constexpr int nodes = Dim + 1, unknowns = nodes * Dim;

  void number_unknowns(const meshadapt::AnyMesh& any);
  void load(const meshadapt::AnyMesh& any);
  void find_pattern();
  void assemble(const std::vector<double>& stiffness_of);
  /// The unknown of one component at a vertex, -1 if it is held.
  int unknown(meshadapt::VertexId vertex, int component) const {
    return first_unknown_of_[vertex] < 0 ? -1 : first_unknown_of_[vertex] + component;
  }

  const runtime::Executor& executor_;
  const meshadapt::FixedMesh<Dim>& mesh_;
  double lambda_, mu_;                 ///< Lame's constants of stiffness 1
  std::vector<int> first_unknown_of_;  // [vertex], -1 if it is held
  int unknown_count_ = 0;
  Values force_;
  SparseMatrix matrix_;
  LinearSolver<Dim> solver_;
};

extern template class Elasticity<2>;
extern template class Elasticity<3>;

}  // namespace ductile::paper
