/// @file
/// The layout of a mesh in VTK's files: tetrahedra, triangles, edges, in this order. References of
/// elements are in the array "region", those of other cells in "boundary".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

/// VTK's numbers for shapes.
inline constexpr std::uint8_t vtk_vertex = 1, vtk_line = 3, vtk_triangle = 5, vtk_tetrahedron = 10;

/// Calls visit(cells, VTK's type) for each kind of cell.
template <class Visit>
void for_each_vtk_cells(const AnyMesh& mesh, const Visit& visit) {
  visit(mesh.tetrahedra, vtk_tetrahedron);
  visit(mesh.triangles, vtk_triangle);
  visit(mesh.edges, vtk_line);
}

inline std::size_t cell_count(const AnyMesh& mesh) {
  return mesh.tetrahedra.size() + mesh.triangles.size() + mesh.edges.size();
}

/// [cell] 0 if it is not of the kind.
struct CellReferences {
  std::vector<std::int32_t> region, boundary;
};

/// Triangles are the elements of a surface in space, because readers see no more than cells.
inline CellReferences cell_references(const AnyMesh& mesh) {
  CellReferences of;
  const std::uint8_t element = mesh.tetrahedra.size() == 0 ? vtk_triangle : vtk_tetrahedron;
  for_each_vtk_cells(mesh, [&](const auto& cells, std::uint8_t type) {
    const bool elements = type == element;
    auto& those = elements ? of.region : of.boundary;
    auto& others = elements ? of.boundary : of.region;
    those.insert(those.end(), cells.reference.begin(), cells.reference.end());
    others.insert(others.end(), cells.size(), 0);
  });
  return of;
}

/// Calls put(name, components, values) for each field at a place, with three coordinates. Elements
/// are the first cells; others get `missing`, or 0 where numbers are whole.
template <class Put>
void for_each_vtk_field(const AnyMesh& mesh, std::span<const NamedField> fields,
                        NamedField::Place place, double missing, const Put& put) {
  const bool at_vertices = place == NamedField::Place::vertices;
  const std::size_t count = at_vertices ? mesh.vertex_count() : cell_count(mesh);
  for (const NamedField& field : fields) {
    if (field.place != place) continue;
    SpatialField wide = in_space(field, mesh);
    if (const auto whole = whole_values(wide, count * wide.components)) {
      put(field.name, wide.components, *whole);
      continue;
    }
    wide.values.resize(count * wide.components, missing);
    put(field.name, wide.components, wide.values);
  }
}

/// Names of references as VTK's files keep them: "2 10 steel", one on each line.
inline std::vector<std::uint8_t> name_lines(const AnyMesh& mesh) {
  std::vector<std::uint8_t> text;
  for (const ReferenceName& name : mesh.names) {
    const std::string line =
        std::to_string(name.dimension) + " " + std::to_string(name.reference) + " " + name.name;
    for (const char c : line) text.push_back(static_cast<std::uint8_t>(c == '\n' ? ' ' : c));
    text.push_back('\n');
  }
  return text;
}

}  // namespace ductile::meshadapt
