/// @file
/// What differs between triangles and tetrahedra: counts, tables, and the signed volume.
/// Facet i of an element is the one opposite its corner i.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ductile/meshadapt/vector.hpp"

namespace ductile::meshadapt {

using VertexId = std::uint32_t;
using ElementId = std::uint32_t;

/// No vertex, no element.
inline constexpr std::uint32_t none = 0xffffffffU;

/// Counts and tables of a triangle (2) or a tetrahedron (3).
template <int Dim>
struct Simplex;

/// Of a triangle.
template <>
struct Simplex<2> {
  static constexpr int corners = 3, edges = 3;
  static constexpr std::array<std::array<int, 2>, 3> edge{{{0, 1}, {1, 2}, {2, 0}}};
  /// Corners of facet i; the element lies to their left.
  static constexpr std::array<std::array<int, 2>, 3> facet{{{1, 2}, {2, 0}, {0, 1}}};
};

/// Of a tetrahedron.
template <>
struct Simplex<3> {
  static constexpr int corners = 4, edges = 6;
  static constexpr std::array<std::array<int, 2>, 6> edge{
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  /// Corners of facet i, counter-clockwise seen from outside.
  static constexpr std::array<std::array<int, 3>, 4> facet{
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
};

template <int Dim>
using Corners = std::array<VertexId, Dim + 1>;
template <int Dim>
using Facet = std::array<VertexId, Dim>;

/// Twice the signed area, positive when a, b, c turn counter-clockwise. A result whose sign
/// rounding could have changed is returned as 0 (forward error bound: Shewchuk, Discrete Comput.
/// Geom. 18, 1997), so a positive result proves a positive area.
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

/// The same of the corners of an element.
template <int Dim>
double certain_determinant(const std::array<Vector<Dim>, Dim + 1>& p) {
  if constexpr (Dim == 2)
    return certain_determinant(p[0], p[1], p[2]);
  else
    return certain_determinant(p[0], p[1], p[2], p[3]);
}

/// Twice the signed area, as rounding leaves it.
inline double plain_determinant(const std::array<Vector<2>, 3>& p) {
  const Vector<2> u = p[1] - p[0], v = p[2] - p[0];
  return u[0] * v[1] - u[1] * v[0];
}
/// Six times the signed volume, as rounding leaves it.
inline double plain_determinant(const std::array<Vector<3>, 4>& p) {
  return dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0]));
}

/// Outward normal; its length is the edge's length in 2D, twice the triangle's area in 3D.
inline Vector<2> facet_normal(const std::array<Vector<2>, 2>& p) {
  return {{p[1][1] - p[0][1], p[0][0] - p[1][0]}};
}
/// The same of a triangle.
inline Vector<3> facet_normal(const std::array<Vector<3>, 3>& p) {
  return cross(p[1] - p[0], p[2] - p[0]);
}

/// Position of `vertex` among the corners, or -1.
template <std::size_t N>
int corner_of(const std::array<VertexId, N>& corners, VertexId vertex) {
  for (std::size_t i = 0; i < N; ++i)
    if (corners[i] == vertex) return static_cast<int>(i);
  return -1;
}

/// Whether `vertex` is one of the corners.
template <std::size_t N>
bool contains(const std::array<VertexId, N>& corners, VertexId vertex) {
  return corner_of(corners, vertex) >= 0;
}

/// The corners that edge k joins.
template <int Dim>
std::array<VertexId, 2> ends_of_edge(const Corners<Dim>& corners, std::size_t k) {
  const auto& [i, j] = Simplex<Dim>::edge[k];
  return {corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(j)]};
}

/// The corners of facet i, in outward order.
template <int Dim>
Facet<Dim> facet_of(const Corners<Dim>& corners, int i) {
  Facet<Dim> facet;
  for (int k = 0; k < Dim; ++k)
    facet[static_cast<std::size_t>(k)] = corners[static_cast<std::size_t>(
        Simplex<Dim>::facet[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)])];
  return facet;
}

/// The facet opposite `vertex`, which is one of the corners; without branches, because which one it
/// is cannot be foreseen.
template <int Dim>
[[gnu::always_inline]] inline Facet<Dim> facet_opposite(const Corners<Dim>& corners,
                                                        VertexId vertex) {
  int at = 0;
  for (int i = 1; i <= Dim; ++i)
    at += i * static_cast<int>(corners[static_cast<std::size_t>(i)] == vertex);
  return facet_of<Dim>(corners, at);
}

}  // namespace ductile::meshadapt
