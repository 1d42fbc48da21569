/// @file
/// walk: finds the element that contains a point by stepping towards it from a nearby one.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// Positions and corners of the elements of a mesh.
template <int Dim, int Space = Dim>
struct Simplices {
  std::span<const Corners<Dim>> corners_of;    // [element]
  std::span<const Vector<Space>> position_of;  // [vertex]

  std::array<Vector<Space>, Dim + 1> points(ElementId element) const {
    std::array<Vector<Space>, Dim + 1> result;
    for (std::size_t i = 0; i <= Dim; ++i) result[i] = position_of[corners_of[element][i]];
    return result;
  }
};

/// The data that a walk uses.
template <int Dim, int Space = Dim>
struct Walkable {
  Simplices<Dim, Space> elements;
  std::span<const std::array<ElementId, Dim + 1>> neighbour_of;  // [element][facet]
};

template <int Dim>
using Weights = std::array<double, Dim + 1>;  // barycentric, of an element's corners

template <int Dim, int Space>
Weights<Dim> barycentric(const std::array<Vector<Space>, Dim + 1>& corner,
                         const Vector<Space>& point) {
  const Vector<Space> u = corner[1] - corner[0], v = corner[2] - corner[0], p = point - corner[0];
  if constexpr (Dim < Space) {  // of the point's projection to the plane of the triangle
    const Vector<3> normal = cross(u, v);
    const double scale = 1 / dot(normal, normal);
    const double at_u = scale * dot(cross(p, v), normal), at_v = scale * dot(cross(u, p), normal);
    return {1 - at_u - at_v, at_u, at_v};
  } else if constexpr (Dim == 2) {
    const double scale = 1 / (u[0] * v[1] - u[1] * v[0]);
    const double at_u = scale * (p[0] * v[1] - p[1] * v[0]);
    const double at_v = scale * (u[0] * p[1] - u[1] * p[0]);
    return {1 - at_u - at_v, at_u, at_v};
  } else {
    const Vector<3> w = corner[3] - corner[0], vw = cross(v, w), up = cross(u, p);
    const double scale = 1 / dot(u, vw);
    const double at_u = scale * dot(p, vw), at_v = scale * dot(w, up), at_w = -scale * dot(v, up);
    return {1 - at_u - at_v - at_w, at_u, at_v, at_w};
  }
}

/// A point outside by at most this barycentric weight counts as inside: it is on the boundary up to
/// rounding.
inline constexpr double walk_tolerance = 1e-9;

template <int Dim>
struct WalkEnd {
  ElementId element;
  Weights<Dim> weight;
  bool inside;  ///< false: the walk met the boundary or took too long
};

/// Steps across the facet that the point is farthest beyond, until it is beyond none. Over a
/// surface that is also over where the point is beyond both of two triangles, outside of their
/// edge; there it ends, at one of them.
template <int Dim, int Space = Dim>
WalkEnd<Dim> walk(const Walkable<Dim, Space>& mesh, const Vector<Space>& point, ElementId near) {
  constexpr int longest_walk =
      Dim < Space ? 200 : 2000;  // longer walks circle, or go around a hole
  [[maybe_unused]] ElementId before = none;
  WalkEnd<Dim> at{near, {}, false};
  for (int step = 0; step < longest_walk; ++step) {
    if constexpr (Dim == 3)  // hides latency: in large meshes the next step is known late
      for (const ElementId e : mesh.neighbour_of[at.element])
        if (e != none) {
          __builtin_prefetch(&mesh.elements.corners_of[e]);
          __builtin_prefetch(&mesh.neighbour_of[e]);
        }
    at.weight = barycentric<Dim>(mesh.elements.points(at.element), point);
    double lowest = at.weight[0];
    for (std::size_t i = 1; i <= Dim; ++i) lowest = std::min(lowest, at.weight[i]);
    at.inside = lowest >= -walk_tolerance;
    if (at.inside) break;
    ElementId next = none;
    lowest = -walk_tolerance;
    for (std::size_t i = 0; i <= Dim; ++i)
      if (at.weight[i] < lowest && mesh.neighbour_of[at.element][i] != none) {
        lowest = at.weight[i];
        next = mesh.neighbour_of[at.element][i];
      }
    if (next == none) break;
    if constexpr (Dim < Space) {
      if (next == before) break;
      before = at.element;
    }
    at.element = next;
  }
  return at;
}

}  // namespace ductile::meshadapt
