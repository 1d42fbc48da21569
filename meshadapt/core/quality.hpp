/// @file
/// Quality of elements, and lengths of edges, in the metric. A quality of 1 is ideal; near 0 the
/// element is degenerate. The kernels compare quality(), which needs no cubic root; reports show
/// mean_ratio(), which has the same order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <numbers>

#include "core/determinant.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// A site: the data of a vertex that determine the quality of the elements around it.
template <int Dim>
struct Site {
  Vector<Dim> position;
  Metric<Dim> metric;
  double scale = 0;  ///< det(metric)^(1/Dim), the geometric mean of its eigenvalues
  friend bool operator==(const Site&, const Site&) = default;
};

/// Makes the site of a vertex with this position and metric.
template <int Dim>
Site<Dim> make_site(const Vector<Dim>& position, const Metric<Dim>& metric) {
  const double product = determinant(metric);
  return {position, metric, Dim == 2 ? std::sqrt(product) : std::cbrt(product)};
}

/// The squared metric length of an edge, measured by the metric at either end.
struct EndSquares {
  double at_a, at_b;
};

/// End squares of the edge from a to b.
template <int Dim>
[[gnu::always_inline]] inline EndSquares end_squares(const Site<Dim>& a, const Site<Dim>& b) {
  const Vector<Dim> d = b.position - a.position;
  return {squared_length(a.metric, d), squared_length(b.metric, d)};
}

/// Metric length of an edge.
inline double edge_length(const EndSquares& edge) {
  return mean_length(std::sqrt(edge.at_a), std::sqrt(edge.at_b));
}
/// Metric length of the edge from a to b.
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
/// The same for the edge from a to b.
template <int Dim>
bool shorter_than(const Site<Dim>& a, const Site<Dim>& b, double limit) {
  return shorter_than(end_squares(a, b), limit);
}

/// Metric volume of this Euclidean volume, by the scale of the metric.
template <int Dim>
[[gnu::always_inline]] inline double metric_volume(double volume, double scale) {
  return Dim == 2 ? scale * volume : scale * volume * std::sqrt(scale);
}

/// Weight of a corner relative to another in the metric of an element, by the ratio of their
/// scales: the fourth power of the ratio of their densities. Bounded, because beyond that the other
/// corner no longer matters and weights would leave the range of single precision.
template <int Dim>
[[gnu::always_inline]] inline double corner_weight(double ratio) {
  const double square = std::min(ratio, 100.0) * std::min(ratio, 100.0);
  return Dim == 2 ? square * square : square * square * square;
}

/// The metric in which an element's quality is computed, up to a factor that cancels.
template <int Dim>
struct ElementMetric {
  Metric<Dim> metric;
  double scale = 0;  ///< mean over the corners, at most det(metric)^(1/Dim) (Minkowski)
};

/// The weighted mean of the metrics of some corners. A much denser corner decides alone. This is
/// the rule of the unstructured grid adaptation working group (Ibanez et al., Procedia Eng. 203,
/// 2017). Equally dense corners have equal weights: if rounding chose one of them, neighbouring
/// elements would be judged in different directions.
template <int Dim, std::size_t n>
[[gnu::always_inline]] inline ElementMetric<Dim> mean_metric(
    const std::array<const Site<Dim>*, n>& corner) {
  double densest = corner[0]->scale;
  for (std::size_t i = 1; i < n; ++i) densest = std::max(densest, corner[i]->scale);
  const double unit = 1 / densest;
  ElementMetric<Dim> mean;
  for (const Site<Dim>* site : corner) {
    const double weight = corner_weight<Dim>(unit * site->scale);
    mean.metric += weight * site->metric;
    mean.scale += weight * site->scale;
  }
  return mean;
}

/// Sum of the squared metric lengths of all edges, by the identity
/// sum_{i<j} |p_i - p_j|^2 = n sum |p_i|^2 - |sum p_i|^2 with p_0 as the origin.
template <int Dim, int Space>
[[gnu::always_inline]] inline double sum_of_squared_lengths(
    const Metric<Space>& metric, const std::array<const Site<Space>*, Dim + 1>& corner) {
  double squares = 0;
  Vector<Space> sum;
  for (std::size_t i = 1; i < corner.size(); ++i) {
    const Vector<Space> d = corner[i]->position - corner[0]->position;
    squares += squared_length(metric, d);
    sum += d;
  }
  return (Dim + 1) * squares - squared_length(metric, sum);
}

/// Quality from the metric volume, times 2 in 2D or 6 in 3D, and the sum of squared edge lengths.
template <int Dim, std::floating_point Number>
Number quality_from(Number volume, Number squares) {
  constexpr auto root3 = std::numbers::sqrt3_v<Number>;
  if constexpr (Dim == 2)
    return 2 * root3 * volume / squares;
  else
    return 12 * root3 * volume / (squares * std::sqrt(squares));
}

/// The square of twice the metric area of the triangle that u and v span in space.
[[gnu::always_inline]] inline double squared_area(const Metric<3>& metric, const Vector<3>& u,
                                                  const Vector<3>& v) {
  const Vector<3> mv = product(metric, v);
  const double uu = squared_length(metric, u), vv = dot(v, mv), uv = dot(u, mv);
  return uu * vv - uv * uv;
}

/// The ingredients of quality(); the volume is not positive for an element that may be degenerate.
struct VolumeAndSquares {
  double volume = 0, squares = 0;
};

/// The metric volume of an element in its mean metric, times 2 in 2D or 6 in 3D, and the sum of its
/// squared edge lengths.
template <int Dim>
[[gnu::always_inline]] inline VolumeAndSquares volume_and_squares(
    const std::array<const Site<Dim>*, Dim + 1>& corner) {
  std::array<Vector<Dim>, Dim + 1> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = corner[i]->position;
  const double determinant = certain_determinant<Dim>(p);
  if (!(determinant > 0)) return {determinant};
  const auto [metric, scale] = mean_metric<Dim>(corner);
  return {metric_volume<Dim>(determinant, scale), sum_of_squared_lengths<Dim>(metric, corner)};
}
/// The same of a triangle in space, which has no sign.
template <int Dim>
[[gnu::always_inline]] inline VolumeAndSquares volume_and_squares(
    const std::array<const Site<3>*, 3>& corner) {
  if (!(certain_area(corner[0]->position, corner[1]->position, corner[2]->position) > 0)) return {};
  const Metric<3> metric = mean_metric<3>(corner).metric;
  const double square = squared_area(metric, corner[1]->position - corner[0]->position,
                                     corner[2]->position - corner[0]->position);
  return {std::sqrt(std::max(square, 0.0)), sum_of_squared_lengths<2>(metric, corner)};
}

/// Quality of an element in its mean metric: 4 sqrt(3) A / (sum of squared lengths) in 2D; the
/// volume-length ratio 72 sqrt(3) V / (sum of squared lengths)^(3/2) in 3D (Parthasarathy, Graichen
/// & Hathaway, Finite Elem. Anal. Des. 15, 1994). At most 1, for a regular element whose corners'
/// metrics differ by factors; 0 or less for one that is not certain to have a positive volume.
template <int Dim, int Space>
double quality(const std::array<const Site<Space>*, Dim + 1>& corner) {
  const auto [volume, squares] = volume_and_squares<Dim>(corner);
  return volume > 0 ? quality_from<Dim>(volume, squares) : volume;
}

/// The measure of an element; the volume is 0 unless quality(corner) > bar, which is decided
/// without root and division; bar is not negative.
template <int Dim, int Space>
[[gnu::always_inline]] inline VolumeAndSquares if_quality_above(
    const std::array<const Site<Space>*, Dim + 1>& corner, double bar) {
  const auto [volume, squares] = volume_and_squares<Dim>(corner);
  if (!(volume > 0)) return {};
  const bool above = Dim == 2 ? 2 * std::sqrt(3.0) * volume > bar * squares
                              : 432 * volume * volume > bar * bar * (squares * squares * squares);
  return above ? VolumeAndSquares{volume, squares} : VolumeAndSquares{};
}

/// quality(corner) > bar, decided without the root and the division; bar is not negative.
template <int Dim, int Space>
bool quality_above(const std::array<const Site<Space>*, Dim + 1>& corner, double bar) {
  return if_quality_above<Dim>(corner, bar).volume > 0;
}

/// quality(corner) if that is above a bar that is not negative, 0 otherwise.
template <int Dim, int Space>
double quality_if_above(const std::array<const Site<Space>*, Dim + 1>& corner, double bar) {
  const auto [volume, squares] = if_quality_above<Dim>(corner, bar);
  return volume > 0 ? quality_from<Dim>(volume, squares) : 0;
}

/// Mean ratio from quality: 12 (3V)^(2/3) / (sum of the six squared lengths) in 3D (Liu & Joe, BIT
/// 34, 1994), quality itself in 2D.
template <int Dim>
double mean_ratio(double quality) {
  return Dim == 2 || quality <= 0 ? quality : std::cbrt(quality * quality);
}

/// The quality with this mean ratio.
template <int Dim>
double quality_of_mean_ratio(double ratio) {
  return Dim == 2 ? ratio : ratio * std::sqrt(ratio);
}

}  // namespace ductile::meshadapt
