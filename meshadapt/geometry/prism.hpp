/// @file
/// Prism: all that lies over a simplex, at a right angle to it, and what of other simplices does.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ductile/meshadapt/vector.hpp"

namespace ductile::meshadapt {

/// Over a triangle in 3D, or over a segment (in 3D all around it).
template <int Dim, std::size_t Corners>
class Prism {
 public:
  using Points = std::array<Vector<Dim>, Corners>;

  /// A point by its weights: those of the simplex's corners after the first in the point below.
  struct Place {
    Vector<Dim> point;
    std::array<double, Corners - 1> weight;
  };
  /// The corners of a part of a simplex, convex but for rounding.
  class Part {
   public:
    void push_back(const Place& place) { places_[size_++] = place; }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const Place& operator[](std::size_t i) const { return places_[i]; }
    const Place* begin() const { return places_.data(); }
    const Place* end() const { return places_.data() + size_; }

   private:
    std::array<Place, 3 * Corners> places_{};  // each side adds half as many at most
    std::size_t size_ = 0;
  };

  /// Over one that is flat there is nothing.
  explicit Prism(const Points& simplex) : corner_(simplex) {
    const Vector<Dim> u = simplex[1] - simplex[0];
    if constexpr (Corners == 2) {
      gradient_[0] = (1 / dot(u, u)) * u;
    } else {
      const Vector<Dim> v = simplex[2] - simplex[0], normal = cross(u, v);
      const double scale = 1 / dot(normal, normal);
      gradient_ = {scale * cross(v, normal), scale * cross(normal, u)};
    }
  }

  /// What of this simplex lies over the prism's: cut by one side after another (Sutherland and
  /// Hodgman, Comm. ACM 17, 1974).
  Part inside(const Points& simplex) const {
    Part part;
    for (const Vector<Dim>& point : simplex) part.push_back(place(point));
    for (std::size_t side = 0; side < Corners && !part.empty(); ++side) part = cut(part, side);
    return part;
  }

  /// How much of the simplex is below a part, 1 being all.
  double share(const Part& part) const {
    double sum = 0;
    if constexpr (Corners == 2) {
      double low = 1, high = 0;
      for (const Place& p : part) {
        low = std::min(low, p.weight[0]);
        high = std::max(high, p.weight[0]);
      }
      sum = std::max(0.0, high - low);
    } else {
      for (std::size_t i = 0; i < part.size(); ++i) {
        const auto &a = part[i].weight, &b = part[(i + 1) % part.size()].weight;
        sum += a[0] * b[1] - a[1] * b[0];
      }
    }
    return std::abs(sum);
  }

  /// The point of the simplex below a place.
  Vector<Dim> below(const Place& place) const {
    Vector<Dim> point = corner_[0];
    for (std::size_t i = 0; i + 1 < Corners; ++i)
      point += place.weight[i] * (corner_[i + 1] - corner_[0]);
    return point;
  }

 private:
  Place place(const Vector<Dim>& point) const {
    Place result{point, {}};
    for (std::size_t i = 0; i + 1 < Corners; ++i)
      result.weight[i] = dot(point - corner_[0], gradient_[i]);
    return result;
  }

  /// The weight of a corner, 0 on the side across.
  static double weight(const Place& place, std::size_t corner) {
    if (corner > 0) return place.weight[corner - 1];
    double rest = 1;
    for (const double w : place.weight) rest -= w;
    return rest;
  }

  static Part cut(const Part& part, std::size_t side) {
    Part result;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Place &here = part[i], &next = part[(i + 1) % part.size()];
      const double a = weight(here, side), b = weight(next, side);
      if (a >= 0) result.push_back(here);
      if ((a < 0) == (b < 0)) continue;
      const double t = a / (a - b);
      Place between{here.point + t * (next.point - here.point), {}};
      for (std::size_t k = 0; k + 1 < Corners; ++k)
        between.weight[k] = here.weight[k] + t * (next.weight[k] - here.weight[k]);
      result.push_back(between);
    }
    return result;
  }

  Points corner_;
  std::array<Vector<Dim>, Corners - 1> gradient_;
};

}  // namespace ductile::meshadapt
