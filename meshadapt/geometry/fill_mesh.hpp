/// @file
/// fill_mesh: copies vertices and elements of a file's mesh into one that is to be adapted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/marked_points.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// Fills an empty mesh: positions, references, corners, required vertices and elements, which lie
/// on no patch yet. Thread safety: one caller; runs on the executor.
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

}  // namespace ductile::meshadapt
