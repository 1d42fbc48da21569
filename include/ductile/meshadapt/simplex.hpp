/// @file
/// Vector<Dim>, a point or a displacement; counts and tables of triangles and tetrahedra. Facet i
/// of an element is the one opposite its corner i.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace ductile::meshadapt {

/// A point, or a displacement, in Dim dimensions.
template <int Dim>
struct Vector {
  std::array<double, Dim> x{};

  double& operator[](int axis) { return x[static_cast<std::size_t>(axis)]; }
  double operator[](int axis) const { return x[static_cast<std::size_t>(axis)]; }

  Vector& operator+=(const Vector& b) {
    for (int i = 0; i < Dim; ++i) (*this)[i] += b[i];
    return *this;
  }
  Vector& operator-=(const Vector& b) {
    for (int i = 0; i < Dim; ++i) (*this)[i] -= b[i];
    return *this;
  }
  Vector& operator*=(double s) {
    for (int i = 0; i < Dim; ++i) (*this)[i] *= s;
    return *this;
  }
  friend Vector operator+(Vector a, const Vector& b) { return a += b; }
  friend Vector operator-(Vector a, const Vector& b) { return a -= b; }
  friend Vector operator*(Vector a, double s) { return a *= s; }
  friend Vector operator*(double s, Vector a) { return a *= s; }
  friend bool operator==(const Vector&, const Vector&) = default;
};

/// Scalar product.
template <int Dim>
double dot(const Vector<Dim>& a, const Vector<Dim>& b) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i) sum += a[i] * b[i];
  return sum;
}

/// Euclidean length.
template <int Dim>
double norm(const Vector<Dim>& a) {
  return std::sqrt(dot(a, a));
}

/// Vector product.
inline Vector<3> cross(const Vector<3>& a, const Vector<3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

// ---- Elements ----

using VertexId = std::uint32_t;
using ElementId = std::uint32_t;

/// No vertex, no element.
inline constexpr std::uint32_t none = 0xffffffffU;

/// Counts and tables of a triangle (2) or a tetrahedron (3).
template <int Dim>
struct Simplex;

/// Counts and tables of a triangle.
template <>
struct Simplex<2> {
  static constexpr int corners = 3, edges = 3;
  static constexpr std::array<std::array<int, 2>, 3> edge{{{0, 1}, {1, 2}, {2, 0}}};
  /// Corners of facet i; the element lies to their left.
  static constexpr std::array<std::array<int, 2>, 3> facet{{{1, 2}, {2, 0}, {0, 1}}};
};

/// Counts and tables of a tetrahedron.
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

/// Outward normal; its length is the edge's length in 2D, twice the triangle's area in 3D.
inline Vector<2> facet_normal(const std::array<Vector<2>, 2>& p) {
  return {{p[1][1] - p[0][1], p[0][0] - p[1][0]}};
}
/// The same for a triangle in 3D.
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

/// Is `vertex` one of the corners?
template <std::size_t N>
bool contains(const std::array<VertexId, N>& corners, VertexId vertex) {
  return corner_of(corners, vertex) >= 0;
}

/// The ends of edge k.
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

}  // namespace ductile::meshadapt
