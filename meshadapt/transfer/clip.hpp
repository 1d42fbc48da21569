/// @file
/// Clipper<Dim>: the intersection of two elements, cut into simplices, and integrals over it of
/// products of their hat functions. Points are stored by their barycentric coordinates in both
/// elements, where every facet is a coordinate plane and every hat function a coordinate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/determinant.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "mesh/walk.hpp"

namespace ductile::meshadapt {

/// The clipper's representation of an element.
template <int Dim>
struct Cell {
  std::array<Vector<Dim>, Dim + 1> corner;
  double volume;
};

/// The volume that two elements share, and the integrals over it of hat function i of one times hat
/// function j of the other.
template <int Dim>
struct Overlap {
  double volume = 0;
  std::array<std::array<double, Dim + 1>, Dim + 1> product{};  // [i of one][j of other]
};

/// Clips pairs of elements one after another; reuses its buffer.
template <int Dim>
class Clipper {
 public:
  /// Elements that only touch have no overlap.
  Overlap<Dim> overlap(const Cell<Dim>& one, const Cell<Dim>& other) {
    // The larger element cuts the smaller, so that rounding errors are small relative to the
    // smaller.
    const bool one_cuts = one.volume >= other.volume;
    const Cell<Dim>& cut = one_cuts ? other : one;
    Piece start;
    for (std::size_t i = 0; i <= Dim; ++i) {
      auto& [in_one, in_other] = start[i].in;
      (one_cuts ? in_other : in_one)[i] = 1;
      (one_cuts ? in_one : in_other) =
          barycentric<Dim>((one_cuts ? one : other).corner, cut.corner[i]);
    }
    if (apart(start)) return {};
    pieces_.assign(1, start);
    const std::size_t cutting = one_cuts ? 0 : 1;
    for (std::size_t facet = 0; facet <= Dim && !pieces_.empty(); ++facet) {
      next_.clear();
      for (const Piece& piece : pieces_) cut_off(piece, cutting, facet);
      std::swap(pieces_, next_);
    }
    return sum(1 - cutting, cut.volume);
  }

 private:
  struct Point {
    std::array<Weights<Dim>, 2> in{};  // barycentric coordinates in both elements
  };
  using Piece = std::array<Point, Dim + 1>;

  /// Does a facet of either element separate them?
  static bool apart(const Piece& start) {
    constexpr double touching = 1e-14;
    for (std::size_t which = 0; which < 2; ++which)
      for (std::size_t facet = 0; facet <= Dim; ++facet) {
        double highest = 0;
        for (const Point& p : start) highest = std::max(highest, p.in[which][facet]);
        if (highest <= touching) return true;
      }
    return false;
  }

  /// Adds the part of a piece that lies inside a facet. With a corners inside and b not, it is
  /// the product of a simplex of a corners and one of b + 1: each corner inside with the points
  /// where the edges from it to those outside are cut. A staircase through that product, along
  /// which each step takes the next corner inside or the next outside, is a simplex, and all of
  /// them fill it.
  void cut_off(const Piece& piece, std::size_t cutting, std::size_t facet) {
    std::array<std::size_t, Dim + 1> inside{}, outside{};
    std::size_t a = 0, b = 0;
    bool whole = true;
    for (std::size_t i = 0; i <= Dim; ++i) {
      const double depth = piece[i].in[cutting][facet];
      whole = whole && depth >= 0;
      depth > 0 ? inside[a++] = i : outside[b++] = i;
    }
    if (a == 0) return;
    if (whole) {
      next_.push_back(piece);
      return;
    }
    const auto at = [&](std::size_t i, std::size_t j) {
      const Point& in = piece[inside[i]];
      return j == 0 ? in : crossing(in, piece[outside[j - 1]], cutting, facet);
    };
    // Bit k of `steps`: does step k go to the next corner inside?
    for (unsigned steps = 0; steps < 1U << Dim; ++steps) {
      Piece part;
      std::size_t i = 0, j = 0;
      part[0] = at(0, 0);
      for (std::size_t k = 0; k < Dim && i < a && j <= b; ++k) {
        (steps >> k & 1U) != 0 ? ++i : ++j;
        if (i < a && j <= b) part[k + 1] = at(i, j);
      }
      if (i + 1 == a && j == b) next_.push_back(part);
    }
  }

  static Point crossing(const Point& in, const Point& out, std::size_t cutting, std::size_t facet) {
    const double depth = in.in[cutting][facet];
    const double share = depth / (depth - out.in[cutting][facet]);
    Point result;
    for (std::size_t which = 0; which < 2; ++which)
      for (std::size_t i = 0; i <= Dim; ++i)
        result.in[which][i] = in.in[which][i] + share * (out.in[which][i] - in.in[which][i]);
    result.in[cutting][facet] = 0;
    return result;
  }

  /// Volume of a piece relative to the element of its coordinates.
  static double share_of(const Piece& piece, std::size_t which) {
    std::array<Vector<Dim>, Dim + 1> corner;
    for (std::size_t i = 0; i <= Dim; ++i)
      for (std::size_t axis = 0; axis < Dim; ++axis)
        corner[i].x[axis] = piece[i].in[which][axis + 1];
    return std::abs(plain_determinant(corner));
  }

  /// The integral of a product of linear functions f and g over a simplex is its volume times
  /// (sum of f g + sum of f times sum of g) / ((d + 1) (d + 2)), sums over the corners.
  Overlap<Dim> sum(std::size_t which, double volume) const {
    Overlap<Dim> result;
    for (const Piece& piece : pieces_) {
      const double part = share_of(piece, which) * volume;
      result.volume += part;
      const double weight = part / ((Dim + 1) * (Dim + 2));
      Weights<Dim> all{};
      for (const Point& p : piece)
        for (std::size_t j = 0; j <= Dim; ++j) all[j] += p.in[1][j];
      for (const Point& p : piece)
        for (std::size_t i = 0; i <= Dim; ++i)
          for (std::size_t j = 0; j <= Dim; ++j)
            result.product[i][j] += weight * p.in[0][i] * (p.in[1][j] + all[j]);
    }
    return result;
  }

  std::vector<Piece> pieces_, next_;
};

}  // namespace ductile::meshadapt
