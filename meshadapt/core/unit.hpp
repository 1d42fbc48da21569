/// @file
/// Directions: of a vector, across it, and of several normals in the mean.
#pragma once

#include <cmath>
#include <cstddef>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The vector scaled to length 1; 0 if it is 0.
template <int Dim>
Vector<Dim> unit(const Vector<Dim>& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vector<Dim>{};
}

/// The unit vector along the axis from which a vector is turned most.
template <int Dim>
Vector<Dim> axis_across(const Vector<Dim>& v) {
  int least = 0;
  for (int i = 1; i < Dim; ++i)
    if (std::abs(v[i]) < std::abs(v[least])) least = i;
  Vector<Dim> axis;
  axis[least] = 1;
  return axis;
}

/// The mean direction of normals, by their lengths, to the side of the longest: others may point to
/// either side. 0 if all are. `normal_at(i)` is asked twice for each.
inline Vector<3> mean_direction(std::size_t count, auto&& normal_at) {
  Vector<3> longest, sum;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<3> normal = normal_at(i);
    if (dot(normal, normal) > dot(longest, longest)) longest = normal;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<3> normal = normal_at(i);
    sum += std::copysign(1.0, dot(normal, longest)) * normal;
  }
  return unit(sum);
}

}  // namespace ductile::meshadapt
