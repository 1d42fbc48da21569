/// @file
/// SmallSystem<N>: the normal equations of a least squares problem with N unknowns, accumulated row
/// by row and solved by Cholesky factorisation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ductile::meshadapt {

template <std::size_t N, std::size_t Sides = 1>
class SmallSystem {
 public:
  using Row = std::array<double, N>;
  using Values = std::array<double, Sides>;

  /// Adds the equations row . x = values, one for each right-hand side.
  void add(const Row& row, const Values& values) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += row[i] * row[j];
      for (std::size_t k = 0; k < Sides; ++k) side_[i][k] += row[i] * values[k];
    }
  }

  /// Adds `amount` of the largest diagonal entry to the diagonal: unknowns that the equations do
  /// not determine become as small as possible.
  void regularise(double amount) {
    double largest = 0;
    for (std::size_t i = 0; i < N; ++i) largest = std::max(largest, matrix_[i][i]);
    for (std::size_t i = 0; i < N; ++i) matrix_[i][i] += amount * (largest > 0 ? largest : 1);
  }

  /// Solves in place; false if a pivot falls below `least_pivot` times its diagonal entry, or that
  /// falls below `least_pivot` squared of the largest: then equations that are all but void, such
  /// as those for xy of points on the axes, are the only ones to hold the unknown.
  bool solve(double least_pivot) {
    double largest = 0;
    for (std::size_t i = 0; i < N; ++i) largest = std::max(largest, matrix_[i][i]);
    const double least = least_pivot * least_pivot * largest;
    for (std::size_t j = 0; j < N; ++j) {
      const double diagonal = matrix_[j][j];
      for (std::size_t k = 0; k < j; ++k) matrix_[j][j] -= matrix_[j][k] * matrix_[j][k];
      if (!(matrix_[j][j] > least_pivot * diagonal) || diagonal < least) return false;
      matrix_[j][j] = std::sqrt(matrix_[j][j]);
      for (std::size_t i = j + 1; i < N; ++i) {
        for (std::size_t k = 0; k < j; ++k) matrix_[i][j] -= matrix_[i][k] * matrix_[j][k];
        matrix_[i][j] /= matrix_[j][j];
      }
    }
    for (std::size_t side = 0; side < Sides; ++side) substitute(side);
    return true;
  }

  double solution(std::size_t unknown, std::size_t side = 0) const { return side_[unknown][side]; }

 private:
  void substitute(std::size_t side) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < i; ++k) side_[i][side] -= matrix_[i][k] * side_[k][side];
      side_[i][side] /= matrix_[i][i];
    }
    for (std::size_t i = N; i-- > 0;) {
      for (std::size_t k = i + 1; k < N; ++k) side_[i][side] -= matrix_[k][i] * side_[k][side];
      side_[i][side] /= matrix_[i][i];
    }
  }

  std::array<Row, N> matrix_{};   // lower triangle
  std::array<Values, N> side_{};  // [unknown][side]
};

}  // namespace ductile::meshadapt
