#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ductile/meshadapt/metric.hpp"
#include "move/paths.hpp"

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
Vector<2> turned(const Vector<2>& d, const Vector<3>&, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c * d[0] - s * d[1], s * d[0] + c * d[1]}};
}
Vector<3> turned(const Vector<3>& d, const Vector<3>& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * d + s * cross(axis, d) + (1 - c) * dot(axis, d) * axis;
}

/// Axis times d.
Vector<2> quarter_turn(const Vector<2>& d, const Vector<3>&) { return {{-d[1], d[0]}}; }
Vector<3> quarter_turn(const Vector<3>& d, const Vector<3>& axis) { return cross(axis, d); }

/// The part of d along the axis.
Vector<2> along(const Vector<2>&, const Vector<3>&) { return {}; }
Vector<3> along(const Vector<3>& d, const Vector<3>& axis) { return dot(axis, d) * axis; }

/// Sets angle and axis of the closest rotation, from the sums of the products of components of
/// points relative to their centroids.
template <int Dim>
using Products = std::array<std::array<double, Dim>, Dim>;
void set_rotation(RigidMotion<2>& motion, const Products<2>& s) {
  motion.angle = std::atan2(s[0][1] - s[1][0], s[0][0] + s[1][1]);
}
/// The quaternion of the largest eigenvalue (Horn, J. Opt. Soc. Am. A 4, 1987).
void set_rotation(RigidMotion<3>& motion, const Products<3>& s) {
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
  motion.angle = 2 * std::atan2(sine, q[0]);
  if (sine > 0) motion.axis = 1 / sine * v;
}

}  // namespace

template <int Dim>
Vector<Dim> RigidMotion<Dim>::moved(const Vector<Dim>& point, double share) const {
  return pivot + share * shift + turned(point - pivot, axis, share * angle);
}

template <int Dim>
RigidMotion<Dim> closest_motion(const std::vector<Vector<Dim>>& from,
                                const std::vector<Vector<Dim>>& to) {
  RigidMotion<Dim> motion;
  motion.pivot = mean(from);
  const Vector<Dim> end = mean(to);
  motion.shift = end - motion.pivot;
  Products<Dim> products{};
  double radius = 0;
  for (std::size_t p = 0; p < from.size(); ++p) {
    const Vector<Dim> a = from[p] - motion.pivot, b = to[p] - end;
    radius = std::max(radius, norm(a));
    for (std::size_t i = 0; i < Dim; ++i)
      for (std::size_t j = 0; j < Dim; ++j) products[i][j] += a.x[i] * b.x[j];
  }
  set_rotation(motion, products);
  const Vector<Dim> slide = along(motion.shift, motion.axis), across = motion.shift - slide;
  const double tangent = std::tan(motion.angle / 2);
  if (!(std::abs(motion.angle) > 1e-9)) return motion;
  const Vector<Dim> to_centre =
      0.5 * across + 1 / (2 * tangent) * quarter_turn(across, motion.axis);
  if (norm(to_centre) > 1.05 * radius) return motion;
  motion.pivot += to_centre;
  motion.shift = slide;
  return motion;
}

template struct RigidMotion<2>;
template struct RigidMotion<3>;
template RigidMotion<2> closest_motion(const std::vector<Vector<2>>&,
                                       const std::vector<Vector<2>>&);
template RigidMotion<3> closest_motion(const std::vector<Vector<3>>&,
                                       const std::vector<Vector<3>>&);

}  // namespace ductile::meshadapt
