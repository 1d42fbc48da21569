/// @file
/// How good elements and edges are in the metric: 1 is ideal, towards 0 degenerate.
/// The kernels compare shape(), which needs no cubic root; mean_ratio() is what reports show.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <numbers>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// What a kernel needs to know of a vertex to judge the elements around it.
template <int Dim>
struct Site {
  Vector<Dim> position;
  Metric<Dim> metric;
  double density = 0;  ///< sqrt(det metric), metric volume of a unit volume
  friend bool operator==(const Site&, const Site&) = default;
};

template <int Dim>
Site<Dim> make_site(const Vector<Dim>& position, const Metric<Dim>& metric) {
  return {position, metric, std::sqrt(determinant(metric))};
}

/// The squares of an edge's metric length, as the metric at either end measures it.
struct EndSquares {
  double at_a, at_b;
};

template <int Dim>
[[gnu::always_inline]] inline EndSquares end_squares(const Site<Dim>& a, const Site<Dim>& b) {
  const Vector<Dim> d = b.position - a.position;
  return {squared_length(a.metric, d), squared_length(b.metric, d)};
}

/// Metric length of an edge.
inline double edge_length(const EndSquares& edge) {
  return mean_length(std::sqrt(edge.at_a), std::sqrt(edge.at_b));
}
template <int Dim>
double edge_length(const Site<Dim>& a, const Site<Dim>& b) {
  return edge_length(end_squares(a, b));
}

/// edge_length(edge) < limit, mostly decided without roots and logarithms: the logarithmic mean
/// lies between the geometric mean and the larger of the two end lengths.
inline bool shorter_than(const EndSquares& edge, double limit) {
  const double square = limit * limit;
  if (edge.at_a * edge.at_b >= square * square) return false;
  if (std::max(edge.at_a, edge.at_b) < square) return true;
  return edge_length(edge) < limit;
}
template <int Dim>
bool shorter_than(const Site<Dim>& a, const Site<Dim>& b, double limit) {
  return shorter_than(end_squares(a, b), limit);
}

/// The corner with the densest metric: the metric an element is judged by, as the unstructured grid
/// adaptation working group does (Ibanez et al., Procedia Eng. 203, 2017).
template <int Dim>
const Site<Dim>& densest(const std::array<const Site<Dim>*, Dim + 1>& corner) {
  const Site<Dim>* best = corner[0];
  double density = best->density;
  for (std::size_t i = 1; i < corner.size(); ++i) {  // no branches: any may be the one
    best = corner[i]->density > density ? corner[i] : best;
    density = std::max(density, corner[i]->density);
  }
  return *best;
}

/// Sum of the squared metric lengths of all edges, by the identity
/// sum_{i<j} |p_i - p_j|^2 = n sum |p_i|^2 - |sum p_i|^2 with p_0 as the origin.
template <int Dim>
[[gnu::always_inline]] inline double sum_of_squared_lengths(
    const Metric<Dim>& metric, const std::array<const Site<Dim>*, Dim + 1>& corner) {
  double squares = 0;
  Vector<Dim> sum;
  for (std::size_t i = 1; i < corner.size(); ++i) {
    const Vector<Dim> d = corner[i]->position - corner[0]->position;
    squares += squared_length(metric, d);
    sum += d;
  }
  return (Dim + 1) * squares - squared_length(metric, sum);
}

/// Shape from the metric volume, times 2 in 2D or 6 in 3D, and the sum of squared edge lengths.
template <int Dim, std::floating_point Number>
Number shape_from(Number volume, Number squares) {
  constexpr auto root3 = std::numbers::sqrt3_v<Number>;
  if constexpr (Dim == 2)
    return 2 * root3 * volume / squares;
  else
    return 12 * root3 * volume / (squares * std::sqrt(squares));
}

/// Elements of a shape below this are judged with caution. Good ones look alike from every corner.
/// In 3D none are: it takes 4 to 17 % more time there, and what it gains is within the noise.
template <int Dim>
inline constexpr double doubtful_shape = Dim == 2 ? 0.65 : 0;

/// The largest sum of squared lengths that an element has in the metric of any of its corners.
template <int Dim>
double largest_sum_of_squares(const std::array<const Site<Dim>*, Dim + 1>& corner) {
  double largest = 0;
  for (const Site<Dim>* site : corner)
    largest = std::max(largest, sum_of_squared_lengths<Dim>(site->metric, corner));
  return largest;
}

/// Shape of an element in the metric of its densest corner: 4 sqrt(3) A / (sum of squared lengths)
/// in 2D; the volume-length ratio 72 sqrt(3) V / (sum of squared lengths)^(3/2) in 3D
/// (Parthasarathy, Graichen & Hathaway, Finite Elem. Anal. Des. 15, 1994). 1 for a regular element,
/// 0 or less for one that is not certain to have a positive volume.
///
/// If that is doubtful, in 2D only, the lengths are taken where they are largest: of corners that
/// are nearly as dense but turned, the least change of the metric may make another one the densest,
/// from which the element is a sliver.
template <int Dim>
double shape(const std::array<const Site<Dim>*, Dim + 1>& corner) {
  std::array<Vector<Dim>, Dim + 1> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = corner[i]->position;
  const double determinant = certain_determinant<Dim>(p);
  if (!(determinant > 0)) return determinant;
  const Site<Dim>& judge = densest<Dim>(corner);
  const double volume = judge.density * determinant;
  const double value = shape_from<Dim>(volume, sum_of_squared_lengths<Dim>(judge.metric, corner));
  if (value > doubtful_shape<Dim>) return value;
  return shape_from<Dim>(volume, largest_sum_of_squares<Dim>(corner));
}

/// What shape() is made of; a volume of 0 if shape(corner) > bar does not hold, which is decided
/// without the root and the division; bar is not negative.
struct VolumeAndSquares {
  double volume = 0, squares = 0;
};
template <int Dim>
[[gnu::always_inline]] inline VolumeAndSquares if_shape_above(
    const std::array<const Site<Dim>*, Dim + 1>& corner, double bar) {
  std::array<Vector<Dim>, Dim + 1> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = corner[i]->position;
  const double determinant = certain_determinant<Dim>(p);
  if (!(determinant > 0)) return {};
  const Site<Dim>& judge = densest<Dim>(corner);
  const double volume = judge.density * determinant;
  const auto above = [volume](double limit, double squares) {
    if constexpr (Dim == 2)
      return 2 * std::sqrt(3.0) * volume > limit * squares;
    else
      return 432 * volume * volume > limit * limit * (squares * squares * squares);
  };
  const double squares = sum_of_squared_lengths<Dim>(judge.metric, corner);
  if (above(std::max(bar, doubtful_shape<Dim>), squares)) return {volume, squares};
  if (!above(bar, squares)) return {};
  const double largest = largest_sum_of_squares<Dim>(corner);
  if (!above(bar, largest)) return {};
  return {volume, largest};
}

/// shape(corner) > bar, decided without the root and the division; bar is not negative.
template <int Dim>
bool shape_above(const std::array<const Site<Dim>*, Dim + 1>& corner, double bar) {
  return if_shape_above<Dim>(corner, bar).volume > 0;
}

/// shape(corner) if that is above a bar that is not negative, else 0.
template <int Dim>
double shape_if_above(const std::array<const Site<Dim>*, Dim + 1>& corner, double bar) {
  const auto [volume, squares] = if_shape_above<Dim>(corner, bar);
  return volume > 0 ? shape_from<Dim>(volume, squares) : 0;
}

/// Mean ratio from shape: 12 (3V)^(2/3) / (sum of the six squared lengths) in 3D (Liu & Joe, BIT
/// 34, 1994), shape itself in 2D.
template <int Dim>
double mean_ratio(double shape) {
  return Dim == 2 || shape <= 0 ? shape : std::cbrt(shape * shape);
}

/// The shape whose mean ratio is this.
template <int Dim>
double shape_of_mean_ratio(double ratio) {
  return Dim == 2 ? ratio : ratio * std::sqrt(ratio);
}

}  // namespace ductile::meshadapt
