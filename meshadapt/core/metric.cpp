#include "ductile/meshadapt/metric.hpp"

#include <utility>

namespace ductile::meshadapt {

namespace {

template <int Dim>
using Matrix = std::array<std::array<double, Dim>, Dim>;

/// Zeroes a[p][q] by a rotation and applies it to the columns of v.
template <int Dim>
void rotate(Matrix<Dim>& a, Matrix<Dim>& v, std::size_t p, std::size_t q) {
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  a[p][p] -= t * a[p][q];
  a[q][q] += t * a[p][q];
  a[p][q] = a[q][p] = 0;
  for (std::size_t k = 0; k < Dim; ++k) {
    if (k != p && k != q) {
      const double kp = a[k][p], kq = a[k][q];
      a[k][p] = a[p][k] = c * kp - s * kq;
      a[k][q] = a[q][k] = s * kp + c * kq;
    }
    const double vp = v[k][p], vq = v[k][q];
    v[k][p] = c * vp - s * vq;
    v[k][q] = s * vp + c * vq;
  }
}

template <int Dim>
bool negligible(const Matrix<Dim>& a, std::size_t p, std::size_t q) {
  const double off = std::abs(a[p][q]);
  return off <= 1e-300 || off <= 1e-17 * std::sqrt(std::abs(a[p][p] * a[q][q]));
}

}  // namespace

template <int Dim>
PrincipalAxes<Dim> principal_axes(const Metric<Dim>& metric) {
  Matrix<Dim> a{}, v{};
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = metric(i, j);
  for (std::size_t i = 0; i < Dim; ++i) v[i][i] = 1;
  bool done = false;
  for (int sweep = 0; sweep < 40 && !done; ++sweep) {
    done = true;
    for (std::size_t p = 0; p + 1 < Dim; ++p)
      for (std::size_t q = p + 1; q < Dim; ++q)
        if (!negligible<Dim>(a, p, q)) {
          rotate<Dim>(a, v, p, q);
          done = false;
        }
  }
  PrincipalAxes<Dim> result;
  for (std::size_t i = 0; i < Dim; ++i) {
    result.value[i] = a[i][i];
    for (std::size_t k = 0; k < Dim; ++k) result.vector[i].x[k] = v[k][i];
  }
  return result;
}

template <int Dim>
Metric<Dim> compose(const PrincipalAxes<Dim>& axes) {
  Metric<Dim> result;
  for (std::size_t i = 0; i < Dim; ++i)
    for (std::size_t column = 0, at = 0; column < Dim; ++column)
      for (std::size_t row = 0; row <= column; ++row, ++at)
        result.m[at] += axes.value[i] * axes.vector[i].x[row] * axes.vector[i].x[column];
  return result;
}

template <int Dim>
Metric<Dim> logarithm(const Metric<Dim>& a) {
  PrincipalAxes<Dim> axes = principal_axes(a);
  for (double& value : axes.value) value = std::log(value);
  return compose(axes);
}

namespace {

/// In closed form: the absolute rounding error of an eigenvalue of a logarithm, unlike that of a
/// metric, is as harmless for small eigenvalues as for large ones.
Metric<2> exponential_of(const Metric<2>& a) {
  const double mean = 0.5 * (a.m[0] + a.m[2]), half = 0.5 * (a.m[0] - a.m[2]), off = a.m[1];
  const double radius = std::sqrt(half * half + off * off);
  if (!(radius > 1e-150)) return isotropic<2>(std::exp(-0.5 * mean));  // its square underflows
  const double large = std::exp(mean + radius), small = std::exp(mean - radius);
  // The eigenvectors are (far, off) and (-off, far), or the same with axes exchanged.
  const double far = radius + std::abs(half), share = 0.5 / (radius * far);
  const double near2 = share * off * off, far2 = share * far * far;
  const double first = large * far2 + small * near2, second = large * near2 + small * far2;
  const double mixed = (large - small) * off * (0.5 / radius);
  return {{half > 0 ? first : second, mixed, half > 0 ? second : first}};
}

Metric<3> exponential_of(const Metric<3>& a) {
  PrincipalAxes<3> axes = principal_axes(a);
  for (double& value : axes.value) value = std::exp(value);
  return compose(axes);
}

}  // namespace

template <int Dim>
Metric<Dim> exponential(const Metric<Dim>& a) {
  return exponential_of(a);
}

template PrincipalAxes<2> principal_axes(const Metric<2>&);
template PrincipalAxes<3> principal_axes(const Metric<3>&);
template PrincipalAxes<4> principal_axes(const Metric<4>&);
template Metric<2> compose(const PrincipalAxes<2>&);
template Metric<3> compose(const PrincipalAxes<3>&);
template Metric<2> logarithm(const Metric<2>&);
template Metric<3> logarithm(const Metric<3>&);
template Metric<2> exponential(const Metric<2>&);
template Metric<3> exponential(const Metric<3>&);

}  // namespace ductile::meshadapt
