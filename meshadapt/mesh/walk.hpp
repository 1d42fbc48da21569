/// @file
/// walk: finds the element that a point lies in by stepping from one nearby towards it.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// What a walk needs of a mesh.
template <int Dim>
struct Walkable {
  const std::vector<Corners<Dim>>& corners_of;                      // [element]
  const std::vector<std::array<ElementId, Dim + 1>>& neighbour_of;  // [element][facet]
  const std::vector<Vector<Dim>>& position_of;                      // [vertex]
};

template <int Dim>
using Weights = std::array<double, Dim + 1>;  // barycentric, of an element's corners

template <int Dim>
Weights<Dim> barycentric(std::array<Vector<Dim>, Dim + 1> corner, const Vector<Dim>& point) {
  Weights<Dim> weight;
  double sum = 0;
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const Vector<Dim> at = std::exchange(corner[i], point);
    weight[i] = plain_determinant(corner);
    corner[i] = at;
    sum += weight[i];
  }
  for (double& w : weight) w /= sum;
  return weight;
}

template <int Dim>
Weights<Dim> barycentric(const Walkable<Dim>& mesh, ElementId element, const Vector<Dim>& point) {
  std::array<Vector<Dim>, Dim + 1> corner;
  for (std::size_t i = 0; i < corner.size(); ++i)
    corner[i] = mesh.position_of[mesh.corners_of[element][i]];
  return barycentric<Dim>(corner, point);
}

/// A point this far outside, as a barycentric weight, still counts as inside: it is on the boundary
/// up to rounding.
inline constexpr double walk_tolerance = 1e-9;

template <int Dim>
struct WalkEnd {
  ElementId element;
  Weights<Dim> weight;
  bool inside;  ///< false: the walk met the boundary, or went on for too long
};

/// Steps over the facet that the point is farthest behind, until it is behind none.
template <int Dim>
WalkEnd<Dim> walk(const Walkable<Dim>& mesh, const Vector<Dim>& point, ElementId near) {
  constexpr int longest_walk = 2000;  // more go in circles or around a hole
  WalkEnd<Dim> at{near, {}, false};
  for (int step = 0; step < longest_walk; ++step) {
    at.weight = barycentric(mesh, at.element, point);
    ElementId next = none;
    double lowest = -walk_tolerance;
    bool inside = true;
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (at.weight[i] >= -walk_tolerance) continue;
      inside = false;
      if (at.weight[i] < lowest && mesh.neighbour_of[at.element][i] != none) {
        lowest = at.weight[i];
        next = mesh.neighbour_of[at.element][i];
      }
    }
    at.inside = inside;
    if (next == none) break;
    at.element = next;
  }
  return at;
}

}  // namespace ductile::meshadapt
