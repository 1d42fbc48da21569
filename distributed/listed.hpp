/// @file
/// Listed facets and edges while they are renumbered: the elements that have them, and the marks of
/// edges besides their reference.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "distributed/part.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "mesh/adjacency.hpp"

namespace ductile::distributed {

/// The elements around each vertex of a mesh.
template <int Dim>
meshadapt::VertexElements elements_around(const runtime::Executor& executor, const AnyMesh& mesh) {
  return meshadapt::list_elements<Dim>(executor, meshadapt::elements_in<Dim>(mesh).vertices,
                                       mesh.vertex_count());
}

/// Calls visit(element) for the elements that have all corners of a facet or an edge.
template <int Dim, std::size_t N>
void visit_beside(const AnyMesh& mesh, const meshadapt::VertexElements& around,
                  const std::array<VertexId, N>& corners, auto&& visit) {
  const auto& elements = meshadapt::elements_in<Dim>(mesh).vertices;
  for (const std::uint32_t e : around.elements_of(corners[0])) {
    const auto is_there = [&](VertexId v) { return meshadapt::contains(elements[e], v); };
    if (std::all_of(corners.begin(), corners.end(), is_there)) visit(e);
  }
}

/// Properties of an edge besides its reference, as bits. Triangles have none.
using Marks = std::uint8_t;
inline constexpr Marks ridge_mark = 1, required_mark = 2;

/// [edge or triangle] Marks of all cells.
template <int Corners>
std::vector<Marks> marks_of(const AnyMesh& mesh, const meshadapt::Cells<Corners>& cells) {
  std::vector<Marks> marks(cells.size(), 0);
  if (Corners != 2) return marks;
  for (const std::uint32_t i : mesh.ridges) marks[i] |= ridge_mark;
  for (const std::uint32_t i : mesh.required_edges) marks[i] |= required_mark;
  return marks;
}

/// Lists an edge or a triangle, with its marks.
template <std::size_t N>
void list(AnyMesh& mesh, const std::array<VertexId, N>& corners, std::int32_t reference,
          Marks marks) {
  if constexpr (N == 2) {
    const auto number = static_cast<std::uint32_t>(mesh.edges.size());
    if ((marks & ridge_mark) != 0) mesh.ridges.push_back(number);
    if ((marks & required_mark) != 0) mesh.required_edges.push_back(number);
    mesh.edges.add(corners, reference);
  } else {
    mesh.triangles.add(corners, reference);
  }
}

/// Removes facets without a label. None of them is required.
template <int Dim>
void drop_unlabelled(AnyMesh& mesh) {
  const std::vector<Marks> marks = marks_of(mesh, meshadapt::facets_in<Dim>(mesh));
  const auto all = std::exchange(meshadapt::facets_in<Dim>(mesh), {});
  if (Dim == 2) mesh.ridges.clear();
  for (std::size_t f = 0; f < all.size(); ++f)
    if (all.reference[f] != unlabelled) list(mesh, all.vertices[f], all.reference[f], marks[f]);
}

}  // namespace ductile::distributed
