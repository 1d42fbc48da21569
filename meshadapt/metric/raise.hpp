/// @file
/// raise: makes a metric at least as fine as another, which is what intersections and limits to
/// growth are made of.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ductile/meshadapt/metric.hpp"

namespace ductile::meshadapt::raising {

/// A relative excess of a squared length that may be nothing but rounding.
inline constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

/// cholesky() adds this to a diagonal, so that errors of its factor stay below `rounding`.
inline constexpr double shift = 4 * rounding;

template <int Dim>
using Matrix = std::array<std::array<double, Dim>, Dim>;  // [row][column]

/// Lower Cholesky factor of `a` with its diagonal raised by `shift`. Errors do not depend on how
/// differently the axes are scaled (Demmel, LAPACK Working Note 14, 1989). What is raised covers
/// them: seen from the factor, a tensor that differs from `a` by rounding alone is longer than 1 by
/// no more than that.
template <int Dim>
Matrix<Dim> cholesky(const Metric<Dim>& a) {
  Matrix<Dim> lower{};
  for (std::size_t j = 0; j < Dim; ++j) {
    const double diagonal = a(static_cast<int>(j), static_cast<int>(j));
    double pivot = (1 + shift) * diagonal;
    for (std::size_t k = 0; k < j; ++k) pivot -= lower[j][k] * lower[j][k];
    lower[j][j] = std::sqrt(std::max(pivot, std::numeric_limits<double>::epsilon() * diagonal));
    for (std::size_t i = j + 1; i < Dim; ++i) {
      double rest = a(static_cast<int>(i), static_cast<int>(j));
      for (std::size_t k = 0; k < j; ++k) rest -= lower[i][k] * lower[j][k];
      lower[i][j] = rest / lower[j][j];
    }
  }
  return lower;
}

/// L^-1 b.
template <int Dim>
std::array<double, Dim> solve(const Matrix<Dim>& lower, std::array<double, Dim> b) {
  for (std::size_t i = 0; i < Dim; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= lower[i][k] * b[k];
    b[i] /= lower[i][i];
  }
  return b;
}

/// L^-1 B L^-T: `other` seen from where LL' is the identity.
template <int Dim>
Metric<Dim> seen_from(const Matrix<Dim>& lower, const Metric<Dim>& other) {
  Matrix<Dim> half;  // [column of B], L^-1 B
  for (std::size_t j = 0; j < Dim; ++j) {
    for (std::size_t i = 0; i < Dim; ++i)
      half[j][i] = other(static_cast<int>(i), static_cast<int>(j));
    half[j] = solve<Dim>(lower, half[j]);
  }
  Metric<Dim> seen;
  for (std::size_t row = 0; row < Dim; ++row) {
    std::array<double, Dim> across;
    for (std::size_t j = 0; j < Dim; ++j) across[j] = half[j][row];
    across = solve<Dim>(lower, across);
    for (std::size_t column = row; column < Dim; ++column)
      seen.m[column * (column + 1) / 2 + row] = across[column];
  }
  return seen;
}

/// Intersects `base` with `other`: squared lengths that are longer in `other` by more than
/// `tolerance`, relatively, are raised to those. `base` is only ever added to. True if it was
/// changed.
template <int Dim>
bool raise(Metric<Dim>& base, const Metric<Dim>& other, double tolerance) {
  const Matrix<Dim> lower = cholesky(base);
  const PrincipalAxes<Dim> ratio = principal_axes(seen_from<Dim>(lower, other));
  bool changed = false;
  for (std::size_t i = 0; i < Dim; ++i) {
    const double excess = ratio.value[i] - 1;
    if (!(excess > std::max(tolerance, rounding))) continue;
    std::array<double, Dim> u{};  // L q
    for (std::size_t row = 0; row < Dim; ++row)
      for (std::size_t k = 0; k <= row; ++k) u[row] += lower[row][k] * ratio.vector[i].x[k];
    for (std::size_t column = 0, at = 0; column < Dim; ++column)
      for (std::size_t row = 0; row <= column; ++row, ++at)
        base.m[at] += excess * u[row] * u[column];
    changed = true;
  }
  return changed;
}

/// A tensor by what its squared sizes exceed those of eigenvalues `most`: which of two tensors is
/// finer stays as it is, and no result of an intersection is finer than `most` afterwards.
template <int Dim>
Metric<Dim> above_sizes_of(double most, const Metric<Dim>& tensor) {
  constexpr double closest = 1e-6;
  PrincipalAxes<Dim> axes = principal_axes(tensor);
  for (double& value : axes.value) value /= std::max(1 - value / most, closest);
  return compose(axes);
}
template <int Dim>
Metric<Dim> back_from(double most, const Metric<Dim>& excess) {
  PrincipalAxes<Dim> axes = principal_axes(excess);
  for (double& value : axes.value) value /= 1 + value / most;
  return compose(axes);
}

/// Is no squared length in `fine` shorter than in `coarse` by more than `tolerance`? A yes is
/// certain up to rounding; a no may be one only because it is close. Cheap: Cholesky without roots.
template <int Dim>
bool surely_finer(const Metric<Dim>& fine, const Metric<Dim>& coarse, double tolerance) {
  Matrix<Dim> rest;
#pragma GCC unroll 3
  for (std::size_t i = 0, at = 0; i < Dim; ++i)
#pragma GCC unroll 3
    for (std::size_t j = 0; j <= i; ++j, ++at)
      rest[i][j] = (1 + tolerance) * fine.m[at] - coarse.m[at];
#pragma GCC unroll 3
  for (std::size_t j = 0; j < Dim; ++j) {
    const std::size_t at = j * (j + 3) / 2;
    if (!(rest[j][j] > rounding * (fine.m[at] + coarse.m[at]))) return false;
#pragma GCC unroll 3
    for (std::size_t i = j + 1; i < Dim; ++i) {
      const double multiple = rest[i][j] / rest[j][j];
      for (std::size_t k = j + 1; k <= i; ++k) rest[i][k] -= multiple * rest[k][j];
    }
  }
  return true;
}

/// Does what raise() does, but no eigenvalue exceeds `most`, if none did before. Intersections of
/// stretched tensors are finer than either tensor, so that many of them would end at any size.
template <int Dim>
bool raise_up_to(double most, Metric<Dim>& base, const Metric<Dim>& other, double tolerance) {
  const Metric<Dim> before = base;
  if (!raise(base, other, tolerance)) return false;
  Metric<Dim> finest;
  for (std::size_t i = 0, at = 0; i < Dim; at += ++i + 1) finest.m[at] = most;
  if (surely_finer(finest, base, 0)) return true;
  Metric<Dim> excess = above_sizes_of(most, before);
  raise(excess, above_sizes_of(most, other), rounding);
  base = back_from(most, excess);
  return true;
}

}  // namespace ductile::meshadapt::raising
