/// @file
/// Meshes of a few elements that a test lists, in the Euclidean metric.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/make_mesh.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt::test {

/// Sets the metric, and qualities, of a mesh; and its neighbours, if they are wanted.
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

/// Elements by their corners, of the references given, or 1.
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

}  // namespace ductile::meshadapt::test
