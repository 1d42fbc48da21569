/// @file
/// Meshes with bodies for tests of move(), and what holds of every motion of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <vector>

#include "core/quality.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/move.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::move_test {

using runtime::Executor;
template <int Dim>
using Motion = std::function<Vector<Dim>(const Vector<Dim>&)>;

inline constexpr std::int32_t outside = 2, body = 3;

// ---- Meshes with a body ----

/// An ellipsoid with half axes `axes` around `centre` in the unit box.
template <int Dim>
struct Ellipsoid {
  Vector<Dim> centre, axes;
};

/// Cubes of a grid become ellipsoids: near each, distances are measured by the largest component
/// inside and outside of it, and by their length on its surface. Then everything is adapted.
template <int Dim>
AnyMesh box_with(const Executor& executor, const std::vector<Ellipsoid<Dim>>& bodies, int n) {
  test::Grid grid = test::unit_grid(Dim, n);
  const auto nearness = [](const Ellipsoid<Dim>& one, const Vector<Dim>& point) {
    double largest = 0;
    for (int i = 0; i < Dim; ++i)
      largest = std::max(largest, std::abs(point[i] - one.centre[i]) / one.axes[i]);
    return largest;
  };
  grid.region = [&](const test::Cell& cell) {
    Vector<Dim> middle;
    for (int i = 0; i < Dim; ++i) middle[i] = (cell[static_cast<std::size_t>(i)] + 0.5) / n;
    for (const auto& one : bodies)
      if (nearness(one, middle) < 1) return body;
    return outside;
  };
  AnyMesh mesh = test::make_grid(grid);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    Vector<Dim> point = position_in<Dim>(mesh, v);
    for (const auto& one : bodies) {
      const double near = nearness(one, point);
      if (near == 0 || near > 1.5) continue;
      double square = 0;
      for (int i = 0; i < Dim; ++i) square += std::pow((point[i] - one.centre[i]) / one.axes[i], 2);
      const double share = near <= 1 ? near : (1.5 - near) / 0.5;
      const double scale = 1 - share + share * near / std::sqrt(square);
      point = one.centre + scale * (point - one.centre);
      break;
    }
    std::copy_n(point.x.begin(), Dim, &mesh.coordinates[v * Dim]);
  }
  return adapt(executor, mesh, constant_metric(mesh, 1.0 / n),
               {.gradation = 1.3, .make = {.hausdorff_tolerance = 0.03 / n}})
      .mesh;
}

template <int Dim>
Vector<Dim> along_x(double x, double y = 0) {
  Vector<Dim> result;
  result[0] = x;
  result[1] = y;
  return result;
}
template <int Dim>
Vector<Dim> all(double x) {
  Vector<Dim> result;
  result.x.fill(x);
  return result;
}

template <int Dim>
AnyMesh box_with_ball(const Executor& executor, double x, double radius, int n) {
  Vector<Dim> centre = all<Dim>(0.5);
  centre[0] = x;
  return box_with<Dim>(executor, {{centre, all<Dim>(radius)}}, n);
}

/// The displacement of vertices of bodies; 0 elsewhere.
template <int Dim>
AnyField displacement_of(const AnyMesh& mesh, const Motion<Dim>& motion) {
  std::vector<Vector<Dim>> vectors(mesh.vertex_count());
  const auto& cells = elements_in<Dim>(mesh);
  for (std::size_t e = 0; e < cells.size(); ++e)
    if (cells.reference[e] == body)
      for (const VertexId v : cells.vertices[e])
        vectors[v] = motion(position_in<Dim>(mesh, v)) - position_in<Dim>(mesh, v);
  return vector_field(vectors, "displacement");
}

/// Turns about an axis through the middle of the box.
inline Motion<2> turn(double degrees, Vector<2> centre = {{0.5, 0.5}}) {
  const double angle = degrees * std::numbers::pi / 180;
  return [=](const Vector<2>& p) {
    const Vector<2> d = p - centre;
    return centre + Vector<2>{{std::cos(angle) * d[0] - std::sin(angle) * d[1],
                               std::sin(angle) * d[0] + std::cos(angle) * d[1]}};
  };
}
inline Motion<3> turn_in_space(double degrees, const Vector<3>& axis) {
  const double angle = degrees * std::numbers::pi / 180;
  const Vector<3> unit = 1 / norm(axis) * axis;
  return [=](const Vector<3>& p) {
    const Vector<3> d = p - all<3>(0.5);
    return all<3>(0.5) + std::cos(angle) * d + std::sin(angle) * cross(unit, d) +
           (1 - std::cos(angle)) * dot(unit, d) * unit;
  };
}

// ---- Measures ----

template <int Dim>
double worst_shape(const AnyMesh& mesh) {
  double worst = 1;
  for (const auto& corners : elements_in<Dim>(mesh).vertices) {
    std::array<Site<Dim>, Dim + 1> site;
    std::array<const Site<Dim>*, Dim + 1> at;
    for (std::size_t i = 0; i <= Dim; ++i) {
      site[i] = make_site(position_in<Dim>(mesh, corners[i]), isotropic<Dim>(1));
      at[i] = &site[i];
    }
    worst = std::min(worst, quality<Dim>(at));
  }
  return worst;
}

/// Volume and centroid of bodies, after a motion of their vertices.
template <int Dim>
struct Measures {
  double volume = 0;
  Vector<Dim> centre;
};
template <int Dim>
Measures<Dim> measures(const Executor& executor, AnyMesh mesh, const Motion<Dim>& motion = {}) {
  for (std::size_t v = 0; motion && v < mesh.vertex_count(); ++v) {
    const Vector<Dim> point = motion(position_in<Dim>(mesh, v));
    std::copy_n(point.x.begin(), Dim, &mesh.coordinates[v * Dim]);
  }
  const auto fixed = make_fixed_mesh<Dim>(executor, mesh);
  Measures<Dim> result;
  for (ElementId e = 0; e < fixed.element_count(); ++e) {
    if (elements_in<Dim>(mesh).reference[e] != body) continue;
    result.volume += fixed.volume_of[e];
    for (const auto& point : fixed.points(e))
      result.centre += fixed.volume_of[e] / (Dim + 1) * point;
  }
  result.centre *= 1 / result.volume;
  return result;
}

/// Facets between bodies and the rest by the positions of their corners, after a motion.
template <int Dim>
std::set<std::set<std::array<double, Dim>>> surface_of(const Executor& executor,
                                                       const AnyMesh& mesh, double motion_share = 0,
                                                       const AnyField& displacement = {}) {
  const auto fixed = make_fixed_mesh<Dim>(executor, mesh);
  std::set<std::set<std::array<double, Dim>>> facets;
  for (ElementId e = 0; e < fixed.element_count(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      const ElementId other = fixed.neighbour_of[e][static_cast<std::size_t>(i)];
      if (elements_in<Dim>(mesh).reference[e] != body ||
          (other != none && elements_in<Dim>(mesh).reference[other] == body))
        continue;
      std::set<std::array<double, Dim>> corners;
      for (const VertexId v : facet_of<Dim>(fixed.corners_of[e], i)) {
        auto point = fixed.position_of[v];
        for (int axis = 0; motion_share != 0 && axis < Dim; ++axis)
          point[axis] += displacement.values[v * Dim + static_cast<std::size_t>(axis)];
        corners.insert(point.x);
      }
      facets.insert(corners);
    }
  return facets;
}

/// Moves, and expects what holds of every motion inside the unit box.
template <int Dim>
MovedMesh moved_well(const Executor& executor, const AnyMesh& mesh, const Motion<Dim>& motion,
                     double least_quality, const MoveOptions& options = {}) {
  const AnyField displacement = displacement_of(mesh, motion);
  MovedMesh moved = move(executor, mesh, displacement, options);
  EXPECT_EQ(moved.report.share, 1);
  EXPECT_EQ(test::joined(check_mesh(executor, moved.mesh)), "");
  const auto expected = measures(executor, mesh, motion),
             found = measures<Dim>(executor, moved.mesh);
  EXPECT_NEAR(found.volume / expected.volume, 1, 1e-9);
  EXPECT_LT(norm(found.centre - expected.centre), 1e-9);
  EXPECT_GT(worst_shape<Dim>(moved.mesh), least_quality);
  EXPECT_EQ(surface_of<Dim>(executor, moved.mesh),
            surface_of<Dim>(executor, mesh, 1, displacement));
  const auto tensors = tensors_of<Dim>(executor, moved.metric);
  EXPECT_EQ(tensors.size(), moved.mesh.vertex_count());
  return moved;
}

}  // namespace ductile::meshadapt::move_test
