#include "linear_solver.hpp"

#include <stdexcept>

namespace ductile::paper {

void LinearSolver<2>::factorise(const SparseMatrix& lower) {
  if (!knows_pattern_) factors_.analyzePattern(lower);
  knows_pattern_ = true;
  factors_.factorize(lower);
}

Values LinearSolver<2>::solve(const Values& right, const Values& /*guess*/) const {
  if (factors_.info() != Eigen::Success)
    throw std::runtime_error("expected a positive definite matrix, found one that is not");
  return factors_.solve(right);
}

void LinearSolver<3>::factorise(const SparseMatrix& lower) {
  solver_.setTolerance(1e-6);
  solver_.setMaxIterations(10000);
  matrix_ = lower;
  solver_.compute(matrix_);
}

Values LinearSolver<3>::solve(const Values& right, const Values& guess) const {
  Values result = solver_.solveWithGuess(right, guess);
  if (solver_.info() != Eigen::Success)
    throw std::runtime_error("conjugate gradients did not converge in 10,000 iterations");
  return result;
}

}  // namespace ductile::paper
