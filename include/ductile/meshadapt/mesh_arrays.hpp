/// @file
/// Between the arrays of a simulation and AnyMesh and AnyField: meshes made from coordinates and
/// cells, whose boundary need not be given, and fields made, put side by side and taken apart.
/// For tensors see metric_field.hpp. An AnyMesh consists of arrays already.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Arrays of numbers, entity after entity; vertices are numbered from 0. They are only looked at.
template <std::signed_integral Index>
struct MeshArrays {
  int dimension = 2;                    ///< 2: elements are triangles; 3: tetrahedra
  std::span<const double> coordinates;  ///< [vertex * dimension + axis]
  std::span<const Index> elements;      ///< [element * (dimension + 1) + corner]
  // ---- The rest may be left empty. References that are not given are 0. ----
  std::span<const std::int32_t> element_reference = {};  ///< [element]
  std::span<const Index> facets = {};                    ///< [facet * dimension + corner]
  std::span<const std::int32_t> facet_reference = {};    ///< [facet]
  std::span<const std::int32_t> vertex_reference = {};   ///< [vertex]
  std::string name = {};                                 ///< for messages
};

/// The mesh of these arrays. Facets that are given keep their order and come first, so an index
/// into them is one into AnyMesh::required_edges (or required_triangles in 3D), too. After them
/// come those that list_boundary() finds. Throws InputError, naming the array of the AnyMesh and
/// the index, for arrays whose lengths do not fit together, vertices that there are not, and
/// coordinates that are not finite; whether it is a valid mesh is for adapt() to find, or for
/// check_mesh(). Index is int, long or long long.
/// Thread safety: one caller; runs on the executor.
template <std::signed_integral Index>
AnyMesh mesh_from_arrays(const runtime::Executor& executor, const MeshArrays<Index>& arrays);

/// Lists the facets of one element only, and those between elements of different references, that
/// the mesh does not list yet. Their reference is 0, because nobody gave them one; their corners
/// turn as seen from outside of their element, of two elements that of the lower number. They are
/// in the order of their elements. Returns how many there were. Throws as above.
/// Thread safety: one caller; runs on the executor.
std::size_t list_boundary(const runtime::Executor& executor, AnyMesh& mesh);

extern template AnyMesh mesh_from_arrays(const runtime::Executor&, const MeshArrays<int>&);
extern template AnyMesh mesh_from_arrays(const runtime::Executor&, const MeshArrays<long>&);
extern template AnyMesh mesh_from_arrays(const runtime::Executor&, const MeshArrays<long long>&);

// ---- Fields: all components of a vertex together. Thread safety of all: any thread ----

/// One scalar at each vertex of a mesh of this dimension. Throws InputError unless that is 2 or 3.
AnyField scalar_field(int dimension, std::vector<double> value_of, const std::string& name = "");

/// One vector at each vertex.
template <int Dim>
AnyField vector_field(const std::vector<Vector<Dim>>& vector_of, const std::string& name = "");

/// A mesh, and which vertices of another one it has kept, in their order.
struct JoinedVertices {
  AnyMesh mesh;
  std::vector<std::uint32_t> kept;
};

/// Makes one of vertices that are within a distance of each other, and of facets and edges that
/// become the same: the first of them stays, where it is and with its reference. Throws InputError
/// if two corners of an element or a facet are within that distance, or arrays do not fit together.
JoinedVertices join_vertices(AnyMesh mesh, double tolerance);

/// The values at vertices that were kept.
AnyField at_kept(const AnyField& field, const std::vector<std::uint32_t>& kept);

/// All fields of both, those of `first` before those of `second`. Throws InputError unless they
/// have the same dimension and as many vertices.
AnyField joined(const AnyField& first, const AnyField& second);

/// The fields of an AnyField apart: "NAME", or "NAME_1", "NAME_2", ... if there are several.
/// Throws InputError unless there are values for all vertices.
std::vector<NamedField> named_fields(const AnyField& field, const std::string& name);

/// The values [vertex] of one scalar among the fields, of which the first has index 0. Throws
/// InputError unless there is one.
std::vector<double> scalars_of(const AnyField& field, std::size_t index = 0);

/// The same of a field of vectors.
template <int Dim>
std::vector<Vector<Dim>> vectors_of(const AnyField& field, std::size_t index = 0);

extern template AnyField vector_field(const std::vector<Vector<2>>&, const std::string&);
extern template AnyField vector_field(const std::vector<Vector<3>>&, const std::string&);
extern template std::vector<Vector<2>> vectors_of<2>(const AnyField&, std::size_t);
extern template std::vector<Vector<3>> vectors_of<3>(const AnyField&, std::size_t);

}  // namespace ductile::meshadapt
