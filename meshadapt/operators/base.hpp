/// @file
/// Base: a facet as the base of elements with different apexes. What does not depend on the apex is
/// computed once, so that a kernel can try many apexes over one facet, or two sides of it.
#pragma once

#include <array>

#include "ductile/meshadapt/quality.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Base {
  Vector<Dim>
      normal;  ///< towards the side of the element; as long as the facet is large, twice in 3D
  Vector<Dim> centre;
  Metric<Dim> spread;  ///< of its edges, see spread_of()
  std::array<const Site<Dim>*, Dim> corner{};
  const Site<Dim>* judge = nullptr;  ///< the densest of them
  double squares = 0;                ///< sum of its squared edge lengths there, once weighed
};

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

/// Of a metric with a spread, in which what is off the diagonal is there twice already.
template <int Dim>
double contraction(const Metric<Dim>& metric, const Metric<Dim>& spread) {
  double sum = 0;
  for (std::size_t i = 0; i < metric.m.size(); ++i) sum += metric.m[i] * spread.m[i];
  return sum;
}

/// Sum of the squared lengths of the base's edges.
template <int Dim>
double base_squares(const Base<Dim>& base, const Metric<Dim>& metric) {
  return contraction(metric, base.spread);
}

/// The base whose element lies behind the facet, of which these are the corners in outward order.
/// It is to be weighed before shapes are asked for; whether an apex is above it can be asked at
/// once.
template <int Dim>
Base<Dim> make_base(const std::array<const Site<Dim>*, Dim>& corner) {
  Base<Dim> base;
  base.corner = corner;
  base.judge = corner[0];
  Vector<Dim> sum = corner[0]->position;
  std::array<Vector<Dim>, Dim - 1> side;
  for (std::size_t i = 1; i < Dim; ++i) {
    side[i - 1] = corner[i]->position - corner[0]->position;
    sum += corner[i]->position;
    if (corner[i]->density > base.judge->density) base.judge = corner[i];
  }
  base.centre = (1.0 / Dim) * sum;
  if constexpr (Dim == 2) {
    base.normal = {{-side[0][1], side[0][0]}};
    base.spread = spread_of(side[0]);
  } else {
    base.normal = cross(side[1], side[0]);
    base.spread = spread_of(side[0], side[1]);
  }
  return base;
}

template <int Dim>
void weigh(Base<Dim>& base) {
  base.squares = base_squares(base, base.judge->metric);
}

/// Twice the area, or six times the volume, of the element with this apex; negative underneath. Its
/// sign is not certain.
template <int Dim>
double volume_over(const Base<Dim>& base, const Vector<Dim>& apex) {
  return dot(base.normal, apex - base.centre);
}

/// The sum of all squared edge lengths of an element whose apex is `up` from the centre of its
/// base, in a metric in which those of the base sum up to `squares`: the squares of the distances
/// from a facet's centre to its corners sum up to `squares` / Dim.
template <int Dim>
double squares_over(double squares, const Metric<Dim>& metric, const Vector<Dim>& up) {
  return (Dim + 1.0) / Dim * squares + Dim * squared_length(metric, up);
}

/// The same in the metric of a site.
template <int Dim>
double squares_at(const Base<Dim>& base, const Vector<Dim>& apex, const Site<Dim>& site) {
  return squares_over(base_squares(base, site.metric), site.metric, apex - base.centre);
}

/// Of the element with this apex, the corner whose metric shape() takes the lengths in if it is
/// doubtful.
template <int Dim>
const Site<Dim>& strictest(const Base<Dim>& base, const Site<Dim>& apex) {
  const Site<Dim>* found = &apex;
  double largest = squares_at(base, apex.position, apex);
  for (const Site<Dim>* site : base.corner) {
    const double squares = squares_at(base, apex.position, *site);
    if (squares > largest) found = site;
    largest = std::max(largest, squares);
  }
  return *found;
}

/// shape() of the element with this apex over the base, or under it, but for rounding: 0 or less
/// only says that the volume is not positive. To be confirmed by certain_determinant() before it is
/// acted on.
template <int Dim>
double shape_over(const Base<Dim>& base, const Site<Dim>& apex, bool under = false) {
  const double above = volume_over(base, apex.position);
  const double determinant = under ? -above : above;
  if (!(determinant > 0)) return determinant;
  const bool apex_judges = apex.density > base.judge->density;
  const Site<Dim>& judge = apex_judges ? apex : *base.judge;
  const double squares = squares_over(apex_judges ? base_squares(base, judge.metric) : base.squares,
                                      judge.metric, apex.position - base.centre);
  const double value = shape_from<Dim>(judge.density * determinant, squares);
  if (value > doubtful_shape<Dim>) return value;
  return shape_from<Dim>(judge.density * determinant,
                         squares_at(base, apex.position, strictest(base, apex)));
}

}  // namespace ductile::meshadapt
