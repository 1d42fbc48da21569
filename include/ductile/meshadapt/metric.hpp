/// @file
/// Metric<Dim>: a symmetric positive definite tensor that defines the length of displacements: d
/// has the metric length sqrt(d' M d), and an edge is of the right size when that is 1. Components
/// are stored as in GMF files: m11 m12 m22 in 2D, m11 m12 m22 m13 m23 m33 in 3D.
#pragma once

#include <array>
#include <cmath>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// A symmetric tensor; a metric when it is also positive definite. Its logarithm is one too.
template <int Dim>
struct Metric {
  static constexpr int size = Dim * (Dim + 1) / 2;
  std::array<double, size> m{};

  /// Component (row, column), in either order.
  double operator()(int row, int column) const {
    if (row > column) return (*this)(column, row);
    return m[static_cast<std::size_t>(column * (column + 1) / 2 + row)];
  }
  friend bool operator==(const Metric&, const Metric&) = default;

  Metric& operator+=(const Metric& b) {
    for (std::size_t i = 0; i < m.size(); ++i) m[i] += b.m[i];
    return *this;
  }
  Metric& operator*=(double s) {
    for (double& component : m) component *= s;
    return *this;
  }
  friend Metric operator+(Metric a, const Metric& b) { return a += b; }
  friend Metric operator*(double s, Metric a) { return a *= s; }
};

/// d' M d. Always inlined: only then are loops over it vectorised, and compilers that count all
/// code of a source may otherwise decide differently because of unrelated code.
[[gnu::always_inline]] inline double squared_length(const Metric<2>& a, const Vector<2>& d) {
  return a.m[0] * d[0] * d[0] + 2 * a.m[1] * d[0] * d[1] + a.m[2] * d[1] * d[1];
}
/// The same in 3D.
[[gnu::always_inline]] inline double squared_length(const Metric<3>& a, const Vector<3>& d) {
  return a.m[0] * d[0] * d[0] + a.m[2] * d[1] * d[1] + a.m[5] * d[2] * d[2] +
         2 * (a.m[1] * d[0] * d[1] + a.m[3] * d[0] * d[2] + a.m[4] * d[1] * d[2]);
}

/// M d.
template <int Dim>
Vector<Dim> product(const Metric<Dim>& a, const Vector<Dim>& d) {
  Vector<Dim> result;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) result[i] += a(i, j) * d[j];
  return result;
}

/// Determinant of a metric in 2D.
inline double determinant(const Metric<2>& a) { return a.m[0] * a.m[2] - a.m[1] * a.m[1]; }
/// Uses the pivots of LDL' elimination: the sum of products of cofactors would lose all digits for
/// a rotated metric with a stretch of 1e4 or more.
inline double determinant(const Metric<3>& a) {
  const auto& [xx, xy, yy, xz, yz, zz] = a.m;
  const double second = yy - xy / xx * xy;
  const double rest = yz - xy / xx * xz;
  return xx * second * (zz - xz / xx * xz - rest / second * rest);
}

/// Inverse of a positive definite metric in 2D.
inline Metric<2> inverse(const Metric<2>& a) {
  return (1 / determinant(a)) * Metric<2>{{a.m[2], -a.m[1], a.m[0]}};
}
/// The same in 3D.
inline Metric<3> inverse(const Metric<3>& a) {
  const auto& [xx, xy, yy, xz, yz, zz] = a.m;
  return (1 / determinant(a)) *
         Metric<3>{{yy * zz - yz * yz, xz * yz - xy * zz, xx * zz - xz * xz, xy * yz - xz * yy,
                    xy * xz - xx * yz, xx * yy - xy * xy}};
}

/// Length of an edge that the metrics at its ends measure as `at_one_end` and `at_other`. The size
/// is assumed to vary geometrically along the edge, which gives their logarithmic mean (Alauzet,
/// Finite Elem. Anal. Des. 46, 2010).
inline double mean_length(double at_one_end, double at_other) {
  const double difference = at_one_end - at_other;
  const double sum = at_one_end + at_other;
  const double t = difference / sum;
  if (std::abs(t) < 0.02) return 0.5 * sum * (1 - t * t * (1.0 / 3 + t * t * (4.0 / 45)));
  return difference / std::log(at_one_end / at_other);
}

/// The eigenvalues of a symmetric tensor, in no order, and unit eigenvectors; vector[i] belongs to
/// value[i]. For a metric, 1/sqrt(value[i]) is the size along vector[i].
template <int Dim>
struct PrincipalAxes {
  std::array<double, Dim> value;
  std::array<Vector<Dim>, Dim> vector;
};

/// Uses cyclic Jacobi rotations, which keep small eigenvalues accurate beside large ones (Demmel &
/// Veselic, 1992). Thread safety: any thread.
template <int Dim>
PrincipalAxes<Dim> principal_axes(const Metric<Dim>& a);

/// Composes a tensor: the sum of value[i] vector[i] vector[i]'.
template <int Dim>
Metric<Dim> compose(const PrincipalAxes<Dim>& axes);

/// The tensor with the absolute values of the eigenvalues.
template <int Dim>
Metric<Dim> absolute(const Metric<Dim>& a) {
  PrincipalAxes<Dim> axes = principal_axes(a);
  for (double& value : axes.value) value = std::abs(value);
  return compose(axes);
}

/// Matrix logarithm of a positive definite tensor. Thread safety: any thread.
template <int Dim>
Metric<Dim> logarithm(const Metric<Dim>& a);
/// The exponential of a symmetric tensor: the inverse of logarithm(). Thread safety: any thread.
template <int Dim>
Metric<Dim> exponential(const Metric<Dim>& a);

/// The isotropic metric that asks for edges of this length.
template <int Dim>
Metric<Dim> isotropic(double size) {
  Metric<Dim> a;
  for (int i = 0; i < Dim; ++i) a.m[static_cast<std::size_t>(i * (i + 3) / 2)] = 1 / (size * size);
  return a;
}

extern template PrincipalAxes<2> principal_axes(const Metric<2>&);
extern template PrincipalAxes<3> principal_axes(const Metric<3>&);
extern template Metric<2> compose(const PrincipalAxes<2>&);
extern template Metric<3> compose(const PrincipalAxes<3>&);
extern template Metric<2> logarithm(const Metric<2>&);
extern template Metric<3> logarithm(const Metric<3>&);
extern template Metric<2> exponential(const Metric<2>&);
extern template Metric<3> exponential(const Metric<3>&);

}  // namespace ductile::meshadapt
