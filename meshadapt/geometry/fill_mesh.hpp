/// @file
/// The first steps from a file's mesh to one that is to be adapted: its vertices and elements, and
/// their neighbours. Thread safety of all: one caller; runs on the executor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/marked_points.hpp"
#include "mesh/mesh.hpp"
#include "mesh/neighbours.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

/// Fills an empty mesh: positions, references, corners, required vertices and elements, which lie
/// on no patch yet.
template <int Dim, int Space>
void fill_mesh(const runtime::Executor& executor, const AnyMesh& any,
               const std::vector<Corners<Dim>>& corners, Mesh<Dim, Space>& mesh) {
  mesh.elements_of.reset(executor, 0);
  mesh.grow(executor, any.vertex_count(), corners.size());
  runtime::parallel_for(executor, any.vertex_count(), [&](std::size_t v) {
    mesh.site_of[v].position = position_in<Space>(any, v);
    mesh.reference_of[v] = any.vertex_reference[v];
    mesh.kind_of[v] = {};
  });
  for (const std::uint32_t v : any.corners) mesh.kind_of[v].corner = true;
  for (const std::uint32_t v : any.required_vertices) mesh.kind_of[v].required = true;
  const std::vector<std::uint8_t> marked_of = marked_points(any);
  runtime::parallel_for(executor, any.vertex_count(), [&](std::size_t v) {
    if (marked_of[v] != 0 && !mesh.kind_of[v].required) mesh.kind_of[v].corner = true;
  });
  runtime::parallel_for(executor, corners.size(), [&](std::size_t e) {
    mesh.corners_of[e] = corners[e];
    mesh.patches_of[e].fill(0);
    mesh.changed_at[e] = mesh.epoch;
  });
}

/// Warns of vertices that belong to no element.
template <int Dim, int Space>
void report_unused_vertices(const runtime::Executor& executor, const AnyMesh& any,
                            const Mesh<Dim, Space>& mesh, std::vector<std::string>& warnings) {
  const auto unused = runtime::parallel_reduce(
      executor, mesh.vertex_slots(), std::size_t{0},
      [&](std::size_t v) { return std::size_t{!mesh.vertex_alive(static_cast<VertexId>(v))}; },
      std::plus<>());
  if (unused != 0)
    warnings.push_back(name_of(any) + ": " + std::to_string(unused) + " of " +
                       std::to_string(mesh.vertex_slots()) + " vertices belong to no " +
                       (Dim < Space ? "triangle" : "element") + " and are left out");
}

/// Sets the neighbours of elements, see the function of mesh/neighbours.hpp.
template <int Dim, int Space>
void find_neighbours(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                     Neighbours<Dim>& neighbours) {
  runtime::FreshMemory fresh;
  neighbours.resize_for_overwrite(mesh.element_slots(), fresh);
  fresh.touch(executor);
  find_neighbours<Dim>(
      executor, mesh.corners_of, mesh.vertex_slots(),
      [&mesh](VertexId v) { return mesh.elements_of.of(v); }, neighbours);
}

}  // namespace ductile::meshadapt
