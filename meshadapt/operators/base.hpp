/// @file
/// Base: a triangle as the base of tetrahedra with different apexes, on both sides of it. What does
/// not depend on the apex is computed once. Nothing is a branch: which tetrahedron is good is a
/// matter of chance.
#pragma once

#include <algorithm>
#include <array>

#include "core/determinant.hpp"
#include "core/quality.hpp"

namespace ductile::meshadapt {

/// The tensor whose contraction() with a metric is the sum of the squared lengths of a facet's
/// edges: the sum of their tensor products with themselves. 2D: the facet is one edge.
inline Metric<2> spread_of(const Vector<2>& u) {
  return {{u[0] * u[0], 2 * u[0] * u[1], u[1] * u[1]}};
}
/// 3D: of the triangle that u and v span.
inline Metric<3> spread_of(const Vector<3>& u, const Vector<3>& v) {
  const auto both = [&](int i, int j) {  // of u, v and v - u
    return 2 * (u[i] * u[j] + v[i] * v[j]) - (u[i] * v[j] + u[j] * v[i]);
  };
  return {{both(0, 0), 2 * both(0, 1), both(1, 1), 2 * both(0, 2), 2 * both(1, 2), both(2, 2)}};
}

/// The contraction of a metric with a spread, which holds off-diagonal components twice already.
template <int Dim>
double contraction(const Metric<Dim>& metric, const Metric<Dim>& spread) {
  double sum = 0;
  for (std::size_t i = 0; i < metric.m.size(); ++i) sum += metric.m[i] * spread.m[i];
  return sum;
}

/// The sum of all squared edge lengths of an element whose apex is `up` from the centre of its
/// base, in a metric in which those of the base sum up to `squares`: the squares of the distances
/// from a facet's centre to its corners sum up to `squares` / Dim.
template <int Dim>
double squares_over(double squares, const Metric<Dim>& metric, const Vector<Dim>& up) {
  return (Dim + 1.0) / Dim * squares + Dim * squared_length(metric, up);
}

struct Base {
  Vector<3> normal;  ///< towards the side that is above it; as long as twice its area
  Vector<3> centre;
  Metric<3> spread;       ///< of its edges, see spread_of()
  ElementMetric<3> mean;  ///< of its corners' metrics
  double unit;            ///< inverse of the largest scale
};

/// The triangle with these corners; they turn clockwise seen from above.
[[gnu::always_inline]] inline Base make_base(const std::array<const Site<3>*, 3>& corner) {
  const Vector<3>& first = corner[0]->position;
  const Vector<3> u = corner[1]->position - first, v = corner[2]->position - first;
  return {cross(v, u), (1.0 / 3) * (first + corner[1]->position + corner[2]->position),
          spread_of(u, v), mean_metric<3>(corner),
          1 / std::max({corner[0]->scale, corner[1]->scale, corner[2]->scale})};
}

/// The square of quality() of the tetrahedron with this apex, up to rounding; -1 if its volume is
/// not positive. `side` is 1 if the apex shall be above the base, -1 if it shall be underneath. To
/// be confirmed by certain_determinant() before it is acted on.
[[gnu::always_inline]] inline double squared_quality_over(const Base& base, const Site<3>& apex,
                                                          double side) {
  const Vector<3> up = apex.position - base.centre;
  const double weight = corner_weight<3>(base.unit * apex.scale);
  const Metric<3> metric = base.mean.metric + weight * apex.metric;
  const double scale = base.mean.scale + weight * apex.scale;
  const double volume = side * dot(base.normal, up), scaled = scale * volume;
  const double squares = squares_over(contraction(metric, base.spread), metric, up);
  const double square = 432 * (scaled * scaled * scale) / (squares * squares * squares);
  return volume > 0 && square >= 0 ? square : -1;  // no number if lengths are out of all range
}

}  // namespace ductile::meshadapt
