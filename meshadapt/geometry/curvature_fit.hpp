/// @file
/// CurvatureFit: the principal curvatures of a surface, or a curve in 2D, at a point, from its
/// normals around there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The symmetric tensor in the tangent plane by which normals change with places, by weighted least
/// squares (Rusinkiewicz, "Estimating curvatures and their derivatives on triangle meshes", 3DPVT
/// 2004), about the mean of the places and normals, so that no single normal counts more than
/// others. It is exact on spheres and cylinders, however far away the places are.
template <int Dim>
class CurvatureFit {
  static constexpr std::size_t tangents = Dim - 1;

 public:
  CurvatureFit() = default;
  /// `normal` is that of the point, of unit length.
  explicit CurvatureFit(const Vector<Dim>& normal) : normal_(normal) {
    int least = 0;
    for (int i = 1; i < Dim; ++i)
      if (std::abs(normal[i]) < std::abs(normal[least])) least = i;
    Vector<Dim>& along = tangent_[0];
    along[least] = 1;
    along -= normal[least] * normal;
    along *= 1 / norm(along);
    if constexpr (Dim == 3) tangent_[1] = cross(normal, along);
  }

  /// A place, from the point, and the unit normal there, to either side.
  void add(const Vector<Dim>& offset, const Vector<Dim>& normal, double weight) {
    const double side = dot(normal, normal_) < 0 ? -weight : weight;
    std::array<double, tangents> place, turn;
    for (std::size_t i = 0; i < tangents; ++i) {
      place[i] = dot(offset, tangent_[i]);
      turn[i] = side * dot(normal, tangent_[i]);
    }
    weight_ += weight;
    for (std::size_t i = 0; i < tangents; ++i) {
      place_[i] += weight * place[i];
      change_[i] += turn[i];
      for (std::size_t j = 0; j < tangents; ++j) {
        squares_[i][j] += weight * place[i] * place[j];
        changes_[i][j] += turn[i] * place[j];
      }
    }
  }

  /// A function of places: how far they are above what bends like that, up to a constant. Needs
  /// places that were added.
  auto height() const {
    const auto bend = bends();
    std::array<double, tangents> slope = change_;
    for (std::size_t i = 0; i < tangents; ++i) {
      for (std::size_t j = 0; j < tangents; ++j) slope[i] -= bend[i][j] * place_[j];
      slope[i] /= weight_;
    }
    return [this, bend, slope](const Vector<Dim>& offset) {
      double height = dot(offset, normal_);
      for (std::size_t i = 0; i < tangents; ++i) {
        double turn = slope[i];
        for (std::size_t j = 0; j < tangents; ++j)
          turn += bend[i][j] * dot(offset, tangent_[j]) / 2;
        height += turn * dot(offset, tangent_[i]);
      }
      return height;
    };
  }

  /// The absolute principal curvatures and their directions; the first is the normal with 0.
  PrincipalAxes<Dim> curvature() const {
    PrincipalAxes<Dim> result{};
    result.vector[0] = normal_;
    if constexpr (Dim == 2) {
      result.value[1] = std::abs(bends()[0][0]);
      result.vector[1] = tangent_[0];
    } else {
      const auto axes = principal_axes(solved());
      for (std::size_t i = 0; i < 2; ++i) {
        result.value[i + 1] = std::abs(axes.value[i]);
        result.vector[i + 1] = axes.vector[i][0] * tangent_[0] + axes.vector[i][1] * tangent_[1];
      }
    }
    return result;
  }

 private:
  /// The tensor by which normals change with places.
  std::array<std::array<double, tangents>, tangents> bends() const {
    if constexpr (Dim == 2) {
      const double spread = square(0, 0);
      return {{{spread > 0 ? change(0, 0) / spread : 0}}};
    } else {
      const Metric<2> bend = solved();
      return {{{bend(0, 0), bend(0, 1)}, {bend(1, 0), bend(1, 1)}}};
    }
  }

  // About the means.
  double square(std::size_t i, std::size_t j) const {
    return weight_ > 0 ? squares_[i][j] - place_[i] * place_[j] / weight_ : 0;
  }
  double change(std::size_t i, std::size_t j) const {
    return weight_ > 0 ? changes_[i][j] - change_[i] * place_[j] / weight_ : 0;
  }

  /// If all places are on a line, the surface bends in its direction alone.
  Metric<2> solved() const {
    const double trace = square(0, 0) + square(1, 1);
    if (!(trace > 0)) return {};
    const double little = 1e-9 * trace, xy = square(0, 1);
    const double xx = square(0, 0) + little, yy = square(1, 1) + little;
    // x a + y b, x b + y c: the changes along both tangents, of which b is in both.
    const double p = change(0, 0), q = change(0, 1) + change(1, 0), r = change(1, 1);
    const double b = (q - xy * (p / xx + r / yy)) / (xx + yy - xy * xy * (1 / xx + 1 / yy));
    return {{(p - xy * b) / xx, b, (r - xy * b) / yy}};
  }

  Vector<Dim> normal_;
  std::array<Vector<Dim>, tangents> tangent_{};
  double weight_ = 0;
  std::array<double, tangents> place_{}, change_{};  // sums, by weight
  std::array<std::array<double, tangents>, tangents> squares_{}, changes_{};
};

}  // namespace ductile::meshadapt
