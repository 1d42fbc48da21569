/// @file
/// Vector<Dim>: a point or a displacement in the plane or in space, and its products.
#pragma once

#include <array>
#include <cmath>

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

}  // namespace ductile::meshadapt
