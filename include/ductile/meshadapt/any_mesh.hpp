/// @file
/// AnyMesh and AnyField: a mesh, and a field on its vertices, as in a file, with the dimension
/// known only at run time. Readers fill them, writers and pictures take them, and Mesh<Dim> is made
/// from one and turned back into one. Indices start at 0. Only the demands of the file format are
/// checked here; make_mesh checks that it is a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// Cells of one shape with their references (tags). Both arrays have the same length.
template <int Corners>
struct Cells {
  std::vector<std::array<std::uint32_t, Corners>> vertices;  ///< [cell][corner]
  std::vector<std::int32_t> reference;                       ///< [cell]

  std::size_t size() const { return vertices.size(); }
  void add(const std::array<std::uint32_t, Corners>& corners, std::int32_t ref) {
    vertices.push_back(corners);
    reference.push_back(ref);
  }
  friend bool operator==(const Cells&, const Cells&) = default;
};

/// A name for the entities of one dimension with one reference: "wall", "steel".
struct ReferenceName {
  int dimension = 0;           ///< of the entities: 0, vertices; 1, edges; 2, triangles; 3,
                               ///< tetrahedra
  std::int32_t reference = 0;  ///< of the entities
  std::string name;
  friend bool operator==(const ReferenceName&, const ReferenceName&) = default;
};

/// A mesh of dimension 2 or 3 as a file holds it. Cells name vertices, counted from 0.
struct AnyMesh {
  int dimension = 0;                           ///< 2 or 3
  std::vector<double> coordinates;             ///< [vertex * dimension + axis]
  std::vector<std::int32_t> vertex_reference;  ///< [vertex]
  Cells<2> edges;
  Cells<3> triangles;
  Cells<4> tetrahedra;
  std::vector<std::uint32_t> corners;              ///< vertex indices
  std::vector<std::uint32_t> required_vertices;    ///< vertex indices
  std::vector<std::uint32_t> ridges;               ///< indices into edges
  std::vector<std::uint32_t> required_edges;       ///< indices into edges
  std::vector<std::uint32_t> required_triangles;   ///< indices into triangles
  std::vector<std::uint32_t> required_tetrahedra;  ///< indices into tetrahedra
  std::vector<ReferenceName> names;                ///< of references; adaptation keeps them
  std::string name;                                ///< origin, for messages
  int dropped_axis = 2;  ///< for a flat mesh: the axis of space that flatten() dropped

  std::size_t vertex_count() const { return vertex_reference.size(); }
  friend bool operator==(const AnyMesh&, const AnyMesh&) = default;
};

/// Is it a surface alone, triangles in space without tetrahedra?
inline bool is_surface(const AnyMesh& mesh) {
  return mesh.dimension == 3 && mesh.tetrahedra.size() == 0 && mesh.triangles.size() != 0;
}

/// The dimension of what is adapted: 2 for triangles, in the plane or in space, 3 for tetrahedra.
inline int element_dimension(const AnyMesh& mesh) { return is_surface(mesh) ? 2 : mesh.dimension; }

/// The elements of a mesh of dimension Dim: its triangles or its tetrahedra.
template <int Dim>
const Cells<Dim + 1>& elements_in(const AnyMesh& mesh) {
  if constexpr (Dim == 2)
    return mesh.triangles;
  else
    return mesh.tetrahedra;
}
/// The same, mutable.
template <int Dim>
Cells<Dim + 1>& elements_in(AnyMesh& mesh) {
  return const_cast<Cells<Dim + 1>&>(elements_in<Dim>(std::as_const(mesh)));
}

/// The listed facets of a mesh of dimension Dim: its edges or its triangles.
template <int Dim>
const Cells<Dim>& facets_in(const AnyMesh& mesh) {
  if constexpr (Dim == 2)
    return mesh.edges;
  else
    return mesh.triangles;
}
/// The same, mutable.
template <int Dim>
Cells<Dim>& facets_in(AnyMesh& mesh) {
  return const_cast<Cells<Dim>&>(facets_in<Dim>(std::as_const(mesh)));
}

/// Position of a vertex of a mesh of dimension Dim.
template <int Dim>
Vector<Dim> position_in(const AnyMesh& mesh, std::size_t vertex) {
  Vector<Dim> position;
  std::copy_n(&mesh.coordinates[vertex * Dim], Dim, position.x.begin());
  return position;
}

/// Values at the vertices of a mesh, all components of all fields of one vertex together.
struct AnyField {
  enum class Type : int { scalar = 1, vector = 2, symmetric = 3, matrix = 4 };  ///< as in GMF
  int dimension = 0;                                                            ///< 2 or 3
  std::size_t vertex_count = 0;
  std::vector<Type> types;     ///< one per field
  std::vector<double> values;  ///< [vertex * stride + component]; symmetric tensors as in GMF:
                               ///< 2D m11 m12 m22, 3D m11 m12 m22 m13 m23 m33
  std::string name;            ///< origin, for messages
};

/// Components of one field at one vertex: 1, dimension, dimension (dimension + 1) / 2 or
/// dimension^2.
constexpr int component_count(AnyField::Type type, int dimension) {
  return type == AnyField::Type::scalar      ? 1
         : type == AnyField::Type::vector    ? dimension
         : type == AnyField::Type::symmetric ? dimension * (dimension + 1) / 2
                                             : dimension * dimension;
}

/// Components of all fields at one vertex: the stride between the values of two vertices.
constexpr std::size_t stride_of(const AnyField& field) {
  std::size_t stride = 0;
  for (const AnyField::Type type : field.types)
    stride += static_cast<std::size_t>(component_count(type, field.dimension));
  return stride;
}

/// A field with a name. The dimension of its mesh determines the number of components.
struct NamedField {
  enum class Place { vertices, elements };
  std::string name;
  AnyField::Type type = AnyField::Type::scalar;
  std::vector<double> values;  ///< [entity * component_count + component], order as in AnyField
  Place place = Place::vertices;
  bool whole = false;  ///< whole numbers, such as marks, which files of VTK hold as such
};

// ---- A mesh to start from ----

/// References of the sides of a box: boundary edges in 2D, boundary triangles in 3D. Left is x = 0,
/// bottom y = 0, front z = 0; right, top and back are opposite.
struct Side {
  static constexpr int left = 1, right = 2, bottom = 3, top = 4, front = 5, back = 6;
};

/// A box (2D: rectangle) from the origin, cut into equal cells and those into elements: two
/// triangles per cell with alternating diagonals, or six tetrahedra (Kuhn). Its boundary is listed,
/// with a reference for each side; elements have reference 1. `extent` and `cells` are per axis.
/// Throws InputError unless extents are positive, there is a cell along each axis, and 32 bits can
/// count the vertices. Thread safety: any thread.
template <int Dim = 3>
AnyMesh box_mesh(const std::array<double, Dim>& extent, const std::array<int, Dim>& cells);

template <>
AnyMesh box_mesh<2>(const std::array<double, 2>& extent, const std::array<int, 2>& cells);
template <>
AnyMesh box_mesh<3>(const std::array<double, 3>& extent, const std::array<int, 3>& cells);

}  // namespace ductile::meshadapt
