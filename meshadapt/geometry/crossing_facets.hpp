/// @file
/// CrossingFacets: which listed facets of a mesh cross each other. What rounding does to points
/// does not count, if they are points that two facets share, or that lie on both sides of a closed
/// crack.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/determinant.hpp"
#include "core/first_bad.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/scale.hpp"

namespace ductile::meshadapt {

/// Refers to the mesh. Takes a logarithm more than linear in the facets to make.
template <int Dim>
class CrossingFacets {
 public:
  CrossingFacets(const runtime::Executor& executor, const AnyMesh& mesh)
      : mesh_(mesh),
        slack_(scale_of<Dim>(mesh).slack),
        index_(executor, facets().size(), [&](std::size_t f) { return box_around(points(f)); }) {}

  std::size_t size() const { return facets().size(); }

  /// The first of the facets behind this one that crosses it, or no_index.
  /// Thread safety: any thread.
  std::size_t partner_of(std::size_t f) const {
    std::size_t first = no_index;
    const std::array<Vector<Dim>, Dim> here = points(f);
    index_.each_meeting(box_around(here), [&](std::size_t g) {
      if (g <= f || g >= first || share_side(f, g)) return;
      const std::array<Vector<Dim>, Dim> there = points(g);
      if ((crosses(f, here, g, there) || (Dim == 3 && crosses(g, there, f, here))) &&
          depth(here, there) > slack_)
        first = g;
    });
    return first;
  }

 private:
  using Points = std::array<Vector<Dim>, Dim>;

  const Cells<Dim>& facets() const { return facets_in<Dim>(mesh_); }

  Points points(std::size_t f) const { return points_in<Dim>(mesh_, facets().vertices[f]); }

  bool has_vertex(std::size_t f, std::uint32_t v) const {
    const auto& corners = facets().vertices[f];
    return std::find(corners.begin(), corners.end(), v) != corners.end();
  }

  /// Do two facets have all corners in common but one, so that they cannot cross?
  bool share_side(std::size_t f, std::size_t g) const {
    std::size_t common = 0;
    for (const std::uint32_t v : facets().vertices[g]) common += has_vertex(f, v) ? 1 : 0;
    return common + 1 >= Dim;
  }

  /// Does an edge of facet g go through facet f?
  bool crosses(std::size_t f, const Points& at_f, std::size_t g, const Points& at_g) const {
    std::array<int, Dim> side{};  // of f that each corner of g is on; 0 in its plane
    for (std::size_t i = 0; i < Dim; ++i)
      if (!has_vertex(f, facets().vertices[g][i])) side[i] = side_of(at_f, at_g[i]);
    for (std::size_t i = 0; i < Dim; ++i) {
      const std::size_t j = (i + 1) % Dim;
      if (side[i] * side[j] < 0 && goes_inside(at_f, at_g[i], at_g[j])) return true;
    }
    return false;
  }

  static int side_of(const Points& facet, const Vector<Dim>& point) {
    std::array<Vector<Dim>, Dim + 1> corners;
    std::copy(facet.begin(), facet.end(), corners.begin());
    corners[Dim] = point;
    return turn(corners);
  }

  /// The sign of a determinant, 0 if it is not certain.
  static int turn(const std::array<Vector<Dim>, Dim + 1>& corners) {
    const double determinant = certain_determinant<Dim>(corners);
    return (determinant > 0 ? 1 : 0) - (determinant < 0 ? 1 : 0);
  }

  /// True if the line through p and q, on either side of a facet, meets its plane inside the facet.
  static bool goes_inside(const Points& facet, const Vector<Dim>& p, const Vector<Dim>& q) {
    std::array<int, Dim> side;
    for (std::size_t i = 0; i < Dim; ++i) {
      if constexpr (Dim == 2)
        side[i] = (i == 0 ? 1 : -1) * turn({p, q, facet[i]});
      else
        side[i] = turn({p, q, facet[i], facet[(i + 1) % 3]});
    }
    return side[0] != 0 &&
           std::all_of(side.begin(), side.end(), [&](int s) { return s == side[0]; });
  }

  /// By how far one of two facets that cross would have to be moved so that they do not. Facets are
  /// apart if their shadows on some line are: one along a normal or, in 3D, across an edge of each.
  static double depth(const Points& f, const Points& g) {
    double least = std::numeric_limits<double>::infinity();
    const auto look_along = [&](const Vector<Dim>& direction) {
      const double length = norm(direction);
      if (!(length > 0)) return;
      const auto [low_f, high_f] = shadow(f, f[0], direction);
      const auto [low_g, high_g] = shadow(g, f[0], direction);
      least = std::min(least, std::min(high_f - low_g, high_g - low_f) / length);
    };
    look_along(facet_normal(f));
    look_along(facet_normal(g));
    if constexpr (Dim == 3)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          look_along(cross(f[(i + 1) % 3] - f[i], g[(j + 1) % 3] - g[j]));
    return least;
  }

  /// From where to where points lie along a direction, seen from an origin.
  static std::pair<double, double> shadow(const Points& points, const Vector<Dim>& origin,
                                          const Vector<Dim>& direction) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector<Dim>& point : points) {
      const double along = dot(point - origin, direction);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    return {low, high};
  }

  const AnyMesh& mesh_;
  double slack_;  // of depth(), which rounding may make as large
  BoxHierarchy<Dim> index_;
};

}  // namespace ductile::meshadapt
