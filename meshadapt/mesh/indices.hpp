/// @file
/// Checks that the elements of a mesh made by a caller name existing vertices.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

template <int Dim>
bool names_others(const AnyMesh& mesh, std::size_t element) {
  const auto& corners = elements_in<Dim>(mesh).vertices[element];
  return std::any_of(corners.begin(), corners.end(),
                     [&](std::size_t v) { return v >= mesh.vertex_count(); });
}

template <int Dim>
[[noreturn]] void refuse_corners(const AnyMesh& mesh, std::size_t element) {
  refuse(name_of(mesh) + ": " + entry(elements_array<Dim>(), element_name<Dim>(), element) +
         " names a vertex beyond the " + std::to_string(mesh.vertex_count()) + " that there are");
}

/// Throws InputError, naming the first element with an invalid corner.
template <int Dim>
void expect_corners(const runtime::Executor& executor, const AnyMesh& mesh) {
  const std::size_t bad =
      first_bad(executor, elements_in<Dim>(mesh).size(),
                [&](std::size_t element) { return names_others<Dim>(mesh, element); });
  if (bad != no_index) refuse_corners<Dim>(mesh, bad);
}

/// The same for cells of any shape; `kind` is the name of one, `array` that of their array.
template <int N>
void expect_vertices(const AnyMesh& mesh, const Cells<N>& cells, const char* array,
                     const char* kind) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const std::uint32_t v : cells.vertices[i])
      if (v >= mesh.vertex_count())
        refuse(name_of(mesh) + ": " + entry(array, kind, i) + " names vertex " + index_word(v) +
               ", beyond the " + std::to_string(mesh.vertex_count()) + " that there are");
}

/// The same for all cells of a mesh.
inline void expect_all_vertices(const AnyMesh& mesh) {
  expect_vertices(mesh, mesh.edges, "edges.vertices", "edge");
  expect_vertices(mesh, mesh.triangles, "triangles.vertices", "triangle");
  expect_vertices(mesh, mesh.tetrahedra, "tetrahedra.vertices", "tetrahedron");
}

}  // namespace ductile::meshadapt
