/// @file
/// Volumes of elements as determinants: rounded, or with a certain sign.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// Twice the signed area, positive when a, b, c turn counter-clockwise. If rounding could have
/// changed the sign, returns 0 (forward error bound: Shewchuk, Discrete Comput. Geom. 18, 1997), so
/// a positive result proves a positive area.
inline double certain_determinant(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c) {
  constexpr double bound = 3.5 * std::numeric_limits<double>::epsilon();
  const double left = (b[0] - a[0]) * (c[1] - a[1]);
  const double right = (b[1] - a[1]) * (c[0] - a[0]);
  const double determinant = left - right;
  return std::abs(determinant) > bound * (std::abs(left) + std::abs(right)) ? determinant : 0;
}

/// Six times the signed volume, positive when d sees a, b, c counter-clockwise; as in 2D.
inline double certain_determinant(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c,
                                  const Vector<3>& d) {
  constexpr double bound = 8 * std::numeric_limits<double>::epsilon();
  const Vector<3> u = b - a, v = c - a, w = d - a;
  const double p = v[1] * w[2], q = v[2] * w[1], r = v[2] * w[0];
  const double s = v[0] * w[2], t = v[0] * w[1], z = v[1] * w[0];
  const double determinant = u[0] * (p - q) + u[1] * (r - s) + u[2] * (t - z);
  const double permanent = std::abs(u[0]) * (std::abs(p) + std::abs(q)) +
                           std::abs(u[1]) * (std::abs(r) + std::abs(s)) +
                           std::abs(u[2]) * (std::abs(t) + std::abs(z));
  return std::abs(determinant) > bound * permanent ? determinant : 0;
}

/// The same for the corners of an element.
template <int Dim>
double certain_determinant(const std::array<Vector<Dim>, Dim + 1>& p) {
  if constexpr (Dim == 2)
    return certain_determinant(p[0], p[1], p[2]);
  else
    return certain_determinant(p[0], p[1], p[2], p[3]);
}

/// Twice the signed area, with rounding errors.
inline double plain_determinant(const std::array<Vector<2>, 3>& p) {
  const Vector<2> u = p[1] - p[0], v = p[2] - p[0];
  return u[0] * v[1] - u[1] * v[0];
}
/// Six times the signed volume, with rounding errors.
inline double plain_determinant(const std::array<Vector<3>, 4>& p) {
  return dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0]));
}

/// Twice the area of a triangle in space; 0 if rounding could have made it.
inline double certain_area(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) {
  constexpr double bound = 16 * std::numeric_limits<double>::epsilon();
  const Vector<3> u = b - a, v = c - a;
  const double area = norm(cross(u, v));
  return area > bound * norm(u) * norm(v) ? area : 0;
}

/// The facet opposite `vertex`, which is one of the corners. Branch-free, because branches would be
/// unpredictable.
template <int Dim>
[[gnu::always_inline]] inline Facet<Dim> facet_opposite(const Corners<Dim>& corners,
                                                        VertexId vertex) {
  int at = 0;
  for (int i = 1; i <= Dim; ++i)
    at += i * static_cast<int>(corners[static_cast<std::size_t>(i)] == vertex);
  return facet_of<Dim>(corners, at);
}

}  // namespace ductile::meshadapt
