/// @file
/// Rotations, rigid motions, and those closest to given ones.
#pragma once

#include <array>
#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// Does a tensor ask for the same in all directions?
template <int Dim>
bool is_isotropic(const Metric<Dim>& m) {
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j)
      if (m(i, j) != (i == j ? m.m[0] : 0)) return false;
  return true;
}

/// A rotation by `angle` about an axis, which is z in 2D.
template <int Dim>
struct Rotation {
  double angle = 0;
  Vector<3> axis{{0, 0, 1}};

  Vector<Dim> turned(const Vector<Dim>& d) const;
  /// R M R^T.
  Metric<Dim> turned(const Metric<Dim>& m) const;
};

/// A linear map by the images of the unit vectors.
template <int Dim>
using LinearMap = std::array<Vector<Dim>, Dim>;

/// The rotation of the polar decomposition.
Rotation<2> rotation_of(const LinearMap<2>& map);
Rotation<3> rotation_of(const LinearMap<3>& map);

/// The metric of a place that is deformed by `map`, F: sizes stay, and their directions become
/// those of F^-T M F^-1, so that thin elements stay along what they were along.
template <int Dim>
Metric<Dim> deformed(const Metric<Dim>& m, const LinearMap<Dim>& map);

/// The deformation gradient of an element whose corners move.
template <int Dim>
LinearMap<Dim> deformation(const std::array<Vector<Dim>, Dim + 1>& from,
                           const std::array<Vector<Dim>, Dim + 1>& to);

/// A rotation about an axis through `pivot`, which moves by `shift`.
template <int Dim>
struct RigidMotion {
  Vector<Dim> pivot, shift;
  Rotation<Dim> rotation;

  Rotation<Dim> part(double share) const { return {share * rotation.angle, rotation.axis}; }
  Vector<Dim> moved(const Vector<Dim>& point, double share) const {
    return pivot + share * shift + part(share).turned(point - pivot);
  }
};

/// The rigid motion that takes `from` to `to` best in the sense of least squares, chosen as move()
/// says. There is at least one point, and as many of both.
template <int Dim>
RigidMotion<Dim> closest_motion(const std::vector<Vector<Dim>>& from,
                                const std::vector<Vector<Dim>>& to);

extern template struct Rotation<2>;
extern template struct Rotation<3>;

}  // namespace ductile::meshadapt
