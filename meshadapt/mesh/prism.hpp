/// @file
/// Prism: the region perpendicular to a simplex, and the parts of other simplices in it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <boost/container/static_vector.hpp>

#include "core/unit.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The prism over a triangle in 3D, or over a segment (in 3D, all around it).
template <int Dim, std::size_t Corners>
class Prism {
 public:
  using Points = std::array<Vector<Dim>, Corners>;

  /// A point by the weights of the simplex's corners, except the first, in its projection, and by
  /// its offsets across the simplex, one for each normal direction. Uninitialised by default,
  /// because there are many.
  struct Place {
    std::array<double, Corners - 1> weight;
    std::array<double, Dim - Corners + 1> across;

    /// Distance from the simplex's affine span.
    double aside() const {
      if constexpr (Dim == Corners) return std::abs(across[0]);
      return std::hypot(across.front(), across.back());
    }
  };
  /// The corners of a part of a simplex, convex up to rounding. Each side of the prism adds at most
  /// half as many.
  using Part = boost::container::static_vector<
      Place, 3 * Corners,
      boost::container::static_vector_options_t<boost::container::throw_on_overflow<false>>>;

  /// For a degenerate simplex the prism is empty.
  explicit Prism(const Points& simplex) : corner_(simplex) {
    const Vector<Dim> u = simplex[1] - simplex[0];
    if constexpr (Corners == 2) {
      gradient_[0] = (1 / dot(u, u)) * u;
      if constexpr (Dim == 2) {
        across_[0] = unit(Vector<2>{{-u[1], u[0]}});
      } else {
        const int least = std::abs(u[0]) < std::abs(u[1]) ? 0 : 1;
        Vector<3> axis;
        axis[std::abs(u[2]) < std::abs(u[least]) ? 2 : least] = 1;
        across_[0] = unit(cross(u, axis));
        across_[1] = unit(cross(u, across_[0]));
      }
    } else {
      const Vector<Dim> v = simplex[2] - simplex[0], normal = cross(u, v);
      const double scale = 1 / dot(normal, normal);
      gradient_ = {scale * cross(v, normal), scale * cross(normal, u)};
      across_[0] = unit(normal);
    }
    for (std::size_t i = 0; i < gradient_.size(); ++i) size_[i] = norm(gradient_[i]);
  }

  /// Room for the steps of inside(), to use again and again.
  using Clipping = std::array<Part, 2>;

  /// The part of this simplex in the prism: clipped by one side after another (Sutherland and
  /// Hodgman, Comm. ACM 17, 1974). Refers to `clipping`.
  const Part& inside(const Points& simplex, Clipping& clipping) const {
    Part *part = &clipping[0], *next = &clipping[1];
    part->clear();
    unsigned beyond_any = 0, beyond_all = ~0U;  // sides that some, or all, corners lie beyond
    for (const Vector<Dim>& point : simplex) {
      part->push_back(place(point));
      const unsigned beyond = sides_beyond((*part)[part->size() - 1]);
      beyond_any |= beyond;
      beyond_all &= beyond;
    }
    if (beyond_all != 0) part->clear();
    for (std::size_t side = 0; side < Corners && !part->empty(); ++side) {
      if ((beyond_any >> side & 1) == 0) continue;
      cut(*part, side, *next);
      std::swap(part, next);
    }
    return *part;
  }

  /// Does the sphere certainly not reach into the prism?
  bool is_beside(const Vector<Dim>& centre, double radius) const {
    const Vector<Dim> offset = centre - corner_[0];
    double rest = 1, rests_size = 0;
    for (std::size_t i = 0; i < gradient_.size(); ++i) {
      const double weight = dot(offset, gradient_[i]);
      if (weight < -radius * size_[i]) return true;
      rest -= weight;
      rests_size += size_[i];
    }
    return rest < -radius * rests_size;
  }

  /// The share of the simplex that a part covers, from 0 to 1.
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
        const auto &a = part[i].weight, &b = part[i + 1 == part.size() ? 0 : i + 1].weight;
        sum += a[0] * b[1] - a[1] * b[0];
      }
    }
    return std::abs(sum);
  }

  /// The projection of a place to the simplex.
  Vector<Dim> below(const Place& place) const {
    Vector<Dim> point = corner_[0];
    for (std::size_t i = 0; i + 1 < Corners; ++i)
      point += place.weight[i] * (corner_[i + 1] - corner_[0]);
    return point;
  }

 private:
  Place place(const Vector<Dim>& point) const {
    Place result;
    const Vector<Dim> offset = point - corner_[0];
    for (std::size_t i = 0; i < gradient_.size(); ++i) result.weight[i] = dot(offset, gradient_[i]);
    for (std::size_t i = 0; i < across_.size(); ++i) result.across[i] = dot(offset, across_[i]);
    return result;
  }

  /// The weight of a corner, which is 0 on the opposite side.
  static double weight(const Place& place, std::size_t corner) {
    if (corner > 0) return place.weight[corner - 1];
    double rest = 1;
    for (const double w : place.weight) rest -= w;
    return rest;
  }

  /// A bit for each side of the prism beyond which the place lies.
  static unsigned sides_beyond(const Place& place) {
    unsigned sides = 0;
    for (std::size_t side = 0; side < Corners; ++side)
      sides |= static_cast<unsigned>(!(weight(place, side) >= 0)) << side;
    return sides;
  }

  static void cut(const Part& part, std::size_t side, Part& result) {
    result.clear();
    const Place* here = &part.back();
    double a = weight(*here, side);
    for (const Place& next : part) {
      const double b = weight(next, side);
      if ((a < 0) != (b < 0)) result.push_back(between(*here, next, a / (a - b)));
      if (b >= 0) result.push_back(next);
      here = &next;
      a = b;
    }
  }

  static Place between(const Place& a, const Place& b, double t) {
    Place result;
    for (std::size_t k = 0; k < a.weight.size(); ++k)
      result.weight[k] = a.weight[k] + t * (b.weight[k] - a.weight[k]);
    for (std::size_t k = 0; k < a.across.size(); ++k)
      result.across[k] = a.across[k] + t * (b.across[k] - a.across[k]);
    return result;
  }

  Points corner_;
  std::array<Vector<Dim>, Corners - 1> gradient_;
  std::array<double, Corners - 1> size_;  // of the gradients
  std::array<Vector<Dim>, Dim - Corners + 1> across_;
};

}  // namespace ductile::meshadapt
