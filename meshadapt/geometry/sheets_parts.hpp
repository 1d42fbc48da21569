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

/// The box around some points, with a margin.
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

/// A tree of the facets; the parts of each are looked at one by one.
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
    const auto look = [&](std::uint32_t part) {
      const Vector<Dim> at = closest_point(sheets.parts_[part].corner, point);
      const double distance = norm(at - point);
      if (distance < best.distance) best = {distance, at, part};
    };
    if (this->empty()) return best;
    boost::container::small_vector<double, 192> square_of(this->size(),
                                                          boost::container::default_init);
    std::size_t first = 0;
    for (std::size_t i = 0; i < this->size(); ++i) {
      const Vector<Dim> aside = sheets.shape_of_[(*this)[i]].centre - point;
      square_of[i] = dot(aside, aside);
      if (std::pair(square_of[i], (*this)[i]) < std::pair(square_of[first], (*this)[first]))
        first = i;
    }
    look((*this)[first]);
    for (std::size_t i = 0; i < this->size(); ++i) {
      const double reach = best.distance + sheets.shape_of_[(*this)[i]].radius;
      if (square_of[i] < reach * reach) look((*this)[i]);
    }
    return best;
  }
};

}  // namespace ductile::meshadapt
