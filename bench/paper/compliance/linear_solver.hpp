/// @file
/// Symmetric positive definite systems: CHOLMOD's supernodal factors in 2D, where they are small;
/// conjugate gradients with incomplete factors in 3D, where they are not.
#pragma once

#include <Eigen/CholmodSupport>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace ductile::paper {

using SparseMatrix = Eigen::SparseMatrix<double>;  ///< the lower triangle
using Values = Eigen::VectorXd;

template <int Dim>
class LinearSolver;

template <>
class LinearSolver<2> {
 public:
  /// Takes over a matrix, which has the same pattern as earlier ones.
  void factorise(const SparseMatrix& lower);
  /// Throws std::runtime_error if the matrix is not positive definite.
  Values solve(const Values& right, const Values& guess) const;

 private:
  Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> factors_;
  bool knows_pattern_ = false;
};

template <>
class LinearSolver<3> {
 public:
  LinearSolver() = default;
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  void factorise(const SparseMatrix& lower);
  Values solve(const Values& right, const Values& guess) const;

 private:
  SparseMatrix matrix_;  ///< the solver refers to it
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower, Eigen::IncompleteCholesky<double>> solver_;
};

}  // namespace ductile::paper
