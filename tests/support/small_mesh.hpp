/// @file
/// Meshes of a few elements that a test lists, in the Euclidean metric.
#pragma once

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/make_mesh.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt::test {

/// Makes a Mesh with the unit metric and qualities; also returns its neighbours if `wanted` is
/// given.
template <int Dim>
Mesh<Dim> in_unit_metric(const runtime::Executor& executor, const AnyMesh& any,
                         const MakeMeshOptions& options, Neighbours<Dim>* wanted = nullptr) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  auto mesh = make_mesh<Dim>(executor, any, options, neighbours, warnings);
  Metric<Dim> unit;
  for (std::size_t i = 0, k = 0; i < Dim; k += ++i + 1) unit.m[k] = 1;
  for (auto& site : mesh.site_of) site = make_site(site.position, unit);
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
    mesh.host_of[v] = mesh.elements_of.of(v).front();
  update_qualities(executor, mesh);
  if (wanted != nullptr) *wanted = std::move(neighbours);
  return mesh;
}

/// A mesh of these points and elements, with the given references, or 1.
template <int Dim>
AnyMesh listed_mesh(std::initializer_list<Vector<Dim>> points,
                    std::initializer_list<Corners<Dim>> elements,
                    std::vector<std::int32_t> references = {}) {
  AnyMesh any;
  any.dimension = Dim;
  for (const Vector<Dim>& point : points) {
    any.coordinates.insert(any.coordinates.end(), point.x.begin(), point.x.end());
    any.vertex_reference.push_back(0);
  }
  references.resize(elements.size(), 1);
  std::size_t next = 0;
  for (const Corners<Dim>& corners : elements) {
    const std::int32_t reference = references[next++];
    if constexpr (Dim == 2)
      any.triangles.add(corners, reference);
    else
      any.tetrahedra.add(corners, reference);
  }
  return any;
}

/// Elements around the edge 0-1: eight, like the slices of an orange whose upper half was cut away
/// except for a slice of this height with the facets 0-2-3 and 1-2-3; if `covered`, also two
/// elements of another region on top. Boundaries are curved and may change within the tolerance.
inline Mesh<3> half_orange(const runtime::Executor& executor, double height, double tolerance,
                           bool covered = false) {
  AnyMesh any;
  any.dimension = 3;
  any.coordinates = {-1, 0, 0, 1, 0, 0, 0, -1, height, 0, 1, height};
  constexpr std::uint32_t segments = 7, first = 4, top = first + segments - 1;
  for (std::uint32_t i = 1; i < segments; ++i) {
    const double angle = -std::numbers::pi * i / segments;
    any.coordinates.insert(any.coordinates.end(), {0, std::cos(angle), std::sin(angle)});
  }
  any.tetrahedra.add({0, 1, 2, 3}, 1);
  for (std::uint32_t i = 0; i < segments; ++i)
    any.tetrahedra.add({0, 1, i == 0 ? 3 : first + i - 1, i + 1 == segments ? 2 : first + i}, 1);
  if (covered) {
    any.coordinates.insert(any.coordinates.end(), {0, 0, 1});
    any.tetrahedra.add({0, 3, 2, top}, 2);
    any.tetrahedra.add({1, 2, 3, top}, 2);
  }
  any.vertex_reference.assign(any.coordinates.size() / 3, 0);
  return in_unit_metric<3>(executor, any,
                           {.complete_boundary = true, .hausdorff_tolerance = tolerance});
}

/// The patch of an element's facet opposite to one of its corners.
template <int Dim>
PatchId& patch_opposite(Mesh<Dim>& mesh, ElementId element, VertexId corner) {
  const int place = corner_of(mesh.corners_of[element], corner);
  return mesh.patches_of[element][static_cast<std::size_t>(place)];
}

}  // namespace ductile::meshadapt::test
