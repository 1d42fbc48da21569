/// @file
/// CurvatureFit: the curvature of a surface or a curve at a point, from its normals or tangents
/// around there.
#pragma once

#include <array>
#include <cmath>

#include "core/unit.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The tensor by which directions, normals of a surface (3 corners) or tangents of a curve (2),
/// change with places along it, by weighted least squares (Rusinkiewicz, "Estimating curvatures and
/// their derivatives on triangle meshes", 3DPVT 2004), about the mean of the places and directions,
/// so that no single direction counts more than others. That of a surface is symmetric. It is exact
/// on spheres, cylinders and circles, however far away the places are.
template <int Dim, std::size_t Corners>
class CurvatureFit {
  static constexpr std::size_t places = Corners - 1;  // coordinates along it
  static constexpr std::size_t turns = std::min<std::size_t>(Dim, 5 - Corners);  // of directions
  using Tensor = std::array<std::array<double, places>, turns>;

 public:
  CurvatureFit() = default;
  /// `direction` is that of the point, of unit length.
  explicit CurvatureFit(const Vector<Dim>& direction) : direction_(direction) {
    along_[0] = direction;
    if constexpr (Corners == 3) {
      const Vector<Dim> axis = axis_across(direction);
      along_[0] = unit(axis - dot(axis, direction) * direction);
      along_[1] = cross(direction, along_[0]);
    }
  }

  /// A place, from the point, and the unit direction there, to either side.
  void add(const Vector<Dim>& offset, const Vector<Dim>& direction, double weight) {
    const double side = dot(direction, direction_) < 0 ? -weight : weight;
    std::array<double, places> place;
    for (std::size_t i = 0; i < places; ++i) {
      place[i] = dot(offset, along_[i]);
      place_[i] += weight * place[i];
      for (std::size_t j = 0; j <= i; ++j) squares_[i][j] += weight * place[i] * place[j];
    }
    for (std::size_t i = 0; i < turns; ++i) {
      double turn = 0;
      if constexpr (Corners == 3)
        turn = side * dot(direction, along_[i]);
      else
        turn = side * direction[static_cast<int>(i)];
      turn_[i] += turn;
      for (std::size_t j = 0; j < places; ++j) changes_[i][j] += turn * place[j];
    }
    weight_ += weight;
  }

  /// A function of places: how far they are off what bends like that, up to a constant. Needs
  /// places that were added.
  auto rise() const {
    const Tensor bend = tensor();
    std::array<double, turns> slope = turn_;
    for (std::size_t i = 0; i < turns; ++i) {
      for (std::size_t j = 0; j < places; ++j) slope[i] -= bend[i][j] * place_[j];
      slope[i] /= weight_;
    }
    return [this, bend, slope](const Vector<Dim>& offset) {
      std::array<double, turns> rise = slope;
      for (std::size_t i = 0; i < turns; ++i)
        for (std::size_t j = 0; j < places; ++j) rise[i] += bend[i][j] * dot(offset, along_[j]) / 2;
      if constexpr (Corners == 3)
        return (dot(offset, direction_) + dot(offset, rise[0] * along_[0] + rise[1] * along_[1])) *
               direction_;
      else
        return across(offset - dot(offset, direction_) * Vector<Dim>{rise});
    };
  }

  /// The absolute principal curvatures and their directions; the first is across a surface, or
  /// towards the centre of a curve, with 0. A curve bends along itself alone.
  PrincipalAxes<Dim> curvature() const {
    PrincipalAxes<Dim> result{};
    const Tensor bend = tensor();
    if constexpr (Corners == 3) {
      result.vector[0] = direction_;
      const auto axes = principal_axes(Metric<2>{{bend[0][0], bend[0][1], bend[1][1]}});
      for (std::size_t i = 0; i < 2; ++i) {
        result.value[i + 1] = std::abs(axes.value[i]);
        result.vector[i + 1] = axes.vector[i][0] * along_[0] + axes.vector[i][1] * along_[1];
      }
    } else {
      Vector<Dim> turn;
      for (int i = 0; i < Dim; ++i) turn[i] = bend[static_cast<std::size_t>(i)][0];
      turn = across(turn);
      result.value[1] = norm(turn);
      result.vector[0] = unit(turn);
      result.vector[1] = direction_;
      if constexpr (Dim == 3) result.vector[2] = cross(result.vector[0], direction_);
    }
    return result;
  }

 private:
  Vector<Dim> across(const Vector<Dim>& v) const { return v - dot(v, direction_) * direction_; }

  // About the means.
  double square(std::size_t i, std::size_t j) const {
    return weight_ > 0 ? squares_[i][j] - place_[i] * place_[j] / weight_ : 0;
  }
  double change(std::size_t i, std::size_t j) const {
    return weight_ > 0 ? changes_[i][j] - turn_[i] * place_[j] / weight_ : 0;
  }

  /// If all places are on a line, a surface bends in its direction alone.
  Tensor tensor() const {
    Tensor bend{};
    if constexpr (Corners == 2) {
      const double spread = square(0, 0);
      for (std::size_t i = 0; i < turns && spread > 0; ++i) bend[i][0] = change(i, 0) / spread;
    } else {
      const double trace = square(0, 0) + square(1, 1);
      if (!(trace > 0)) return bend;
      const double little = 1e-9 * trace, xy = square(1, 0);
      const double xx = square(0, 0) + little, yy = square(1, 1) + little;
      // x a + y b, x b + y c: the changes along both tangents, of which b is in both.
      const double p = change(0, 0), q = change(0, 1) + change(1, 0), r = change(1, 1);
      const double b = (q - xy * (p / xx + r / yy)) / (xx + yy - xy * xy * (1 / xx + 1 / yy));
      bend = {{{(p - xy * b) / xx, b}, {b, (r - xy * b) / yy}}};
    }
    return bend;
  }

  Vector<Dim> direction_;
  std::array<Vector<Dim>, places> along_{};
  double weight_ = 0;
  std::array<double, places> place_{};  // sums, by weight
  std::array<double, turns> turn_{};
  std::array<std::array<double, places>, places> squares_{};
  Tensor changes_{};
};

}  // namespace ductile::meshadapt
