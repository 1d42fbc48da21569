#include "move/rigid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>

#include "ductile/meshadapt/fixed_mesh.hpp"

namespace ductile::meshadapt {

extern template PrincipalAxes<4> principal_axes(const Metric<4>&);

namespace {

template <int Dim>
Vector<Dim> mean(const std::vector<Vector<Dim>>& points) {
  Vector<Dim> sum;
  for (const Vector<Dim>& point : points) sum += point;
  return 1 / static_cast<double>(points.size()) * sum;
}

/// Rodrigues' formula; in 2D the axis is z.
Vector<2> turned_by(const Vector<2>& d, const Vector<3>&, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c * d[0] - s * d[1], s * d[0] + c * d[1]}};
}
Vector<3> turned_by(const Vector<3>& d, const Vector<3>& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * d + s * cross(axis, d) + (1 - c) * dot(axis, d) * axis;
}

/// The cross product of the axis and d.
Vector<2> quarter_turn(const Vector<2>& d, const Vector<3>&) { return {{-d[1], d[0]}}; }
Vector<3> quarter_turn(const Vector<3>& d, const Vector<3>& axis) { return cross(axis, d); }

/// The part of d along the axis.
Vector<2> along(const Vector<2>&, const Vector<3>&) { return {}; }
Vector<3> along(const Vector<3>& d, const Vector<3>& axis) { return dot(axis, d) * axis; }

template <int Dim>
Vector<Dim> unit_vector(int axis) {
  Vector<Dim> unit;
  unit[axis] = 1;
  return unit;
}

/// F M F^T, where `map` is F.
template <int Dim>
Metric<Dim> pushed(const Metric<Dim>& m, const LinearMap<Dim>& map) {
  Metric<Dim> result;
  std::size_t component = 0;
  for (int column = 0; column < Dim; ++column)
    for (int row = 0; row <= column; ++row, ++component)
      for (std::size_t k = 0; k < Dim; ++k)
        for (std::size_t l = 0; l < Dim; ++l)
          result.m[component] +=
              map[k][row] * m(static_cast<int>(k), static_cast<int>(l)) * map[l][column];
  return result;
}

}  // namespace

template <int Dim>
Vector<Dim> Rotation<Dim>::turned(const Vector<Dim>& d) const {
  return turned_by(d, axis, angle);
}

template <int Dim>
Metric<Dim> Rotation<Dim>::turned(const Metric<Dim>& m) const {
  if (is_isotropic(m) || angle == 0) return m;
  LinearMap<Dim> map;
  for (int i = 0; i < Dim; ++i) map[static_cast<std::size_t>(i)] = turned(unit_vector<Dim>(i));
  return pushed<Dim>(m, map);
}

template <int Dim>
Metric<Dim> deformed(const Metric<Dim>& m, const LinearMap<Dim>& map) {
  const PrincipalAxes<Dim> now = principal_axes(pushed<Dim>(inverse(m), map));
  PrincipalAxes<Dim> result = principal_axes(m);
  std::array<std::size_t, Dim> order;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return now.value[i]; });
  std::ranges::sort(result.value, std::greater<>());
  for (std::size_t i = 0; i < Dim; ++i) result.vector[i] = now.vector[order[i]];
  return compose(result);
}

Rotation<2> rotation_of(const LinearMap<2>& map) {
  return {std::atan2(map[0][1] - map[1][0], map[0][0] + map[1][1]), {{0, 0, 1}}};
}

/// The quaternion of the largest eigenvalue (Horn, J. Opt. Soc. Am. A 4, 1987).
Rotation<3> rotation_of(const LinearMap<3>& s) {
  Metric<4> matrix;
  matrix.m = {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2],
              s[2][0] - s[0][2],           s[0][1] + s[1][0], -s[0][0] + s[1][1] - s[2][2],
              s[0][1] - s[1][0],           s[2][0] + s[0][2], s[1][2] + s[2][1],
              -s[0][0] - s[1][1] + s[2][2]};
  const PrincipalAxes<4> axes = principal_axes(matrix);
  const auto largest = std::max_element(axes.value.begin(), axes.value.end());
  Vector<4> q = axes.vector[static_cast<std::size_t>(largest - axes.value.begin())];
  if (q[0] < 0) q *= -1;
  const Vector<3> v{{q[1], q[2], q[3]}};
  const double sine = norm(v);
  if (!(sine > 0)) return {};
  return {2 * std::atan2(sine, q[0]), 1 / sine * v};
}

template <int Dim>
LinearMap<Dim> deformation(const std::array<Vector<Dim>, Dim + 1>& from,
                           const std::array<Vector<Dim>, Dim + 1>& to) {
  const auto gradient = hat_gradients<Dim>(from);
  LinearMap<Dim> map{};
  for (std::size_t i = 0; i <= Dim; ++i)
    for (int axis = 0; axis < Dim; ++axis)
      map[static_cast<std::size_t>(axis)] += gradient[i][axis] * to[i];
  return map;
}

template <int Dim>
RigidMotion<Dim> closest_motion(const std::vector<Vector<Dim>>& from,
                                const std::vector<Vector<Dim>>& to) {
  RigidMotion<Dim> motion;
  motion.pivot = mean(from);
  const Vector<Dim> end = mean(to);
  motion.shift = end - motion.pivot;
  LinearMap<Dim> products{};
  double radius = 0;
  for (std::size_t p = 0; p < from.size(); ++p) {
    const Vector<Dim> a = from[p] - motion.pivot, b = to[p] - end;
    radius = std::max(radius, norm(a));
    for (std::size_t i = 0; i < Dim; ++i) products[i] += a.x[i] * b;
  }
  motion.rotation = rotation_of(products);
  const auto& [angle, axis] = motion.rotation;
  if (!(std::abs(angle) > 1e-9)) return motion;
  const Vector<Dim> slide = along(motion.shift, axis), across = motion.shift - slide;
  const Vector<Dim> to_centre =
      0.5 * across + 1 / (2 * std::tan(angle / 2)) * quarter_turn(across, axis);
  if (norm(to_centre) > 1.05 * radius) return motion;
  motion.pivot += to_centre;
  motion.shift = slide;
  return motion;
}

template struct Rotation<2>;
template struct Rotation<3>;
template Metric<2> deformed<2>(const Metric<2>&, const LinearMap<2>&);
template Metric<3> deformed<3>(const Metric<3>&, const LinearMap<3>&);
template LinearMap<2> deformation<2>(const std::array<Vector<2>, 3>&,
                                     const std::array<Vector<2>, 3>&);
template LinearMap<3> deformation<3>(const std::array<Vector<3>, 4>&,
                                     const std::array<Vector<3>, 4>&);
template RigidMotion<2> closest_motion(const std::vector<Vector<2>>&,
                                       const std::vector<Vector<2>>&);
template RigidMotion<3> closest_motion(const std::vector<Vector<3>>&,
                                       const std::vector<Vector<3>>&);

}  // namespace ductile::meshadapt
