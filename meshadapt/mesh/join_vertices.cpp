/// @file
/// join_vertices: vertices that lie together become one, in all arrays of a mesh.
#include <algorithm>
#include <cmath>
#include <utility>

#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/runtime/disjoint_sets.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/indices.hpp"
#include "mesh/sorted_cells.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

namespace {

/// [vertex] The first vertex of those that it lies together with.
template <int Dim>
std::vector<std::uint32_t> first_of_each(const AnyMesh& mesh, double tolerance) {
  const auto box_of = [&](std::size_t v) {
    const auto at = position_in<Dim>(mesh, v);
    return Box<Dim>{at, at};
  };
  const runtime::Executor executor({.threads = 1});
  const BoxHierarchy<Dim> index(executor, mesh.vertex_count(), box_of);
  runtime::DisjointSets sets(executor, mesh.vertex_count());
  for (std::uint32_t v = 0; v < sets.size(); ++v) {
    const auto at = position_in<Dim>(mesh, v);
    index.each_meeting(grown(box_of(v), tolerance), [&](std::size_t w) {
      if (w < v && norm(position_in<Dim>(mesh, w) - at) <= tolerance)
        sets.unite(v, static_cast<std::uint32_t>(w));
    });
  }
  std::vector<std::uint32_t> first(mesh.vertex_count());
  for (std::uint32_t v = 0; v < first.size(); ++v) first[v] = sets.lowest(v);
  return first;
}

/// Throws if a cell has lost a corner.
template <int Corners>
void rename_corners(const AnyMesh& mesh, Cells<Corners>& cells,
                    const std::vector<std::uint32_t>& new_of, const char* kind) {
  for (std::size_t c = 0; c < cells.size(); ++c) {
    auto& corners = cells.vertices[c];
    for (std::uint32_t& corner : corners) corner = new_of[corner];
    auto sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      refuse(Wording(name_of(mesh) + ": two corners of " + kind + " ") + index_word(c) +
             " are no farther apart than the tolerance; expected one below the length of the "
             "shortest edge");
  }
}

/// Keeps the first of facets that have become the same; marked ones are marked in the end.
template <int Corners>
void keep_first(Cells<Corners>& cells, std::initializer_list<std::vector<std::uint32_t>*> marks) {
  const auto sorted = sorted_cells(runtime::Executor({.threads = 1}), cells.vertices);
  std::vector<std::uint32_t> same_as(cells.size()), new_of(cells.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto& [corners, cell] = sorted[i];
    const bool again = i > 0 && corners == sorted[i - 1].first;
    same_as[cell] = again ? same_as[sorted[i - 1].second] : cell;
  }
  Cells<Corners> kept;
  for (std::uint32_t c = 0; c < same_as.size(); ++c) {
    new_of[c] = same_as[c] == c ? static_cast<std::uint32_t>(kept.size()) : new_of[same_as[c]];
    if (same_as[c] == c) kept.add(cells.vertices[c], cells.reference[c]);
  }
  cells = std::move(kept);
  for (std::vector<std::uint32_t>* mark : marks) {
    for (std::uint32_t& cell : *mark) cell = new_of[cell];
    std::sort(mark->begin(), mark->end());
    mark->erase(std::unique(mark->begin(), mark->end()), mark->end());
  }
}

void expect_to_join(const AnyMesh& mesh, double tolerance) {
  expect_coordinates(mesh);
  expect_references(mesh);
  expect_all_vertices(mesh);
  if (!(tolerance >= 0) || !std::isfinite(tolerance))
    throw InputError("tolerance: expected a distance of 0 or more, found " + number(tolerance));
}

}  // namespace

JoinedVertices join_vertices(AnyMesh mesh, double tolerance) {
  expect_to_join(mesh, tolerance);
  const auto first =
      mesh.dimension == 2 ? first_of_each<2>(mesh, tolerance) : first_of_each<3>(mesh, tolerance);
  JoinedVertices result;
  std::vector<std::uint32_t> new_of(first.size());
  const auto d = static_cast<std::size_t>(mesh.dimension);
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    new_of[v] = first[v] == v ? static_cast<std::uint32_t>(result.kept.size()) : new_of[first[v]];
    if (first[v] != v) continue;
    std::copy_n(mesh.coordinates.begin() + static_cast<std::ptrdiff_t>(v * d), d,
                mesh.coordinates.begin() + static_cast<std::ptrdiff_t>(result.kept.size() * d));
    mesh.vertex_reference[result.kept.size()] = mesh.vertex_reference[v];
    result.kept.push_back(v);
  }
  mesh.coordinates.resize(result.kept.size() * d);
  mesh.vertex_reference.resize(result.kept.size());
  rename_corners(mesh, mesh.edges, new_of, "edge");
  rename_corners(mesh, mesh.triangles, new_of, "triangle");
  rename_corners(mesh, mesh.tetrahedra, new_of, "tetrahedron");
  keep_first(mesh.edges, {&mesh.ridges, &mesh.required_edges});
  if (d == 3) keep_first(mesh.triangles, {&mesh.required_triangles});
  for (std::vector<std::uint32_t>* mark : {&mesh.corners, &mesh.required_vertices})
    for (std::uint32_t& v : *mark) v = new_of[v];
  result.mesh = std::move(mesh);
  return result;
}

AnyField at_kept(const AnyField& field, const std::vector<std::uint32_t>& kept) {
  AnyField result{field.dimension, kept.size(), field.types, {}, field.name};
  const std::size_t stride = stride_of(field);
  result.values.reserve(kept.size() * stride);
  for (const std::uint32_t v : kept)
    for (std::size_t i = 0; i < stride; ++i) result.values.push_back(field.values[v * stride + i]);
  return result;
}

}  // namespace ductile::meshadapt
