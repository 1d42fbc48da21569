/// @file
/// Box: an axis-parallel box, and bounding boxes of points.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Box {
  Vector<Dim> low, high;

  /// A box without points.
  static Box empty() {
    Box box;
    box.low.x.fill(std::numeric_limits<double>::infinity());
    box.high.x.fill(-std::numeric_limits<double>::infinity());
    return box;
  }

  friend Box join(Box a, const Box& b) {
    for (int i = 0; i < Dim; ++i) {
      a.low[i] = std::min(a.low[i], b.low[i]);
      a.high[i] = std::max(a.high[i], b.high[i]);
    }
    return a;
  }

  /// The box with a margin on all sides.
  friend Box grown(Box box, double margin) {
    for (int i = 0; i < Dim; ++i) {
      box.low[i] -= margin;
      box.high[i] += margin;
    }
    return box;
  }

  /// Do they have a point in common?
  friend bool meet(const Box& a, const Box& b) {
    for (int i = 0; i < Dim; ++i)
      if (a.low[i] > b.high[i] || b.low[i] > a.high[i]) return false;
    return true;
  }
};

/// The box around some points.
template <int Dim, std::size_t N>
Box<Dim> box_around(const std::array<Vector<Dim>, N>& points) {
  auto box = Box<Dim>::empty();
  for (const Vector<Dim>& p : points) box = join(box, {p, p});
  return box;
}

}  // namespace ductile::meshadapt
