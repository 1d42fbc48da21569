/// @file
/// The flat parts of Sheets, for its sources: which are where, and which is the closest.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <boost/container/small_vector.hpp>

#include "core/unit.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "geometry/sheets.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/distance.hpp"

namespace ductile::meshadapt {

/// Of some points, with a margin around them.
template <int Dim, std::size_t N>
Box<Dim> box_around(const std::array<Vector<Dim>, N>& points, double margin) {
  auto box = box_around(points);
  for (int i = 0; i < Dim; ++i) {
    box.low[i] -= margin;
    box.high[i] += margin;
  }
  return box;
}

/// Unit normal of a facet, or along an edge in 3D; 0 if it is too small to have one.
template <int Dim, std::size_t Corners>
Vector<Dim> direction_of(const std::array<Vector<Dim>, Corners>& corner) {
  Vector<Dim> direction;
  if constexpr (Corners == Dim)
    direction = facet_normal(corner);
  else
    direction = corner[1] - corner[0];
  return unit(direction);
}

/// Of the facets: their parts are looked at one by one.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Tree : BoxHierarchy<Dim> {
  using BoxHierarchy<Dim>::BoxHierarchy;
};

/// Calls visit(part) for each part whose box has a point in common with this one.
template <int Dim, std::size_t Corners>
void Sheets<Dim, Corners>::each_meeting(const Box<Dim>& box, auto&& visit) const {
  tree_->each_meeting(box, [&](std::uint32_t facet) {
    for (std::uint32_t part = first_part_[facet]; part < first_part_[facet + 1]; ++part)
      if (meet(box, box_of_[part])) visit(part);
  });
}

/// Some parts, among which the closest to a point is looked for: first where it is likely, then
/// wherever it may be.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Near : boost::container::small_vector<std::uint32_t, 192> {
  Closest closest(const Sheets& sheets, const Vector<Dim>& point) const {
    Closest best;
    const auto square = [&](std::uint32_t part) {
      const Vector<Dim> aside = sheets.shape_of_[part].centre - point;
      return dot(aside, aside);
    };
    const auto look = [&](std::uint32_t part) {
      const Vector<Dim> at = closest_point(sheets.parts_[part].corner, point);
      const double distance = norm(at - point);
      if (distance < best.distance) best = {distance, at, part};
    };
    if (this->empty()) return best;
    look(*std::min_element(this->begin(), this->end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(square(a), a) < std::pair(square(b), b);
    }));
    for (const std::uint32_t part : *this) {
      const double reach = best.distance + sheets.shape_of_[part].radius;
      if (square(part) < reach * reach) look(part);
    }
    return best;
  }
};

}  // namespace ductile::meshadapt
