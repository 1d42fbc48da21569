/// @file
/// Conversion between the arrays of a simulation and AnyMesh and AnyField: makes meshes from
/// coordinates and cells, whose boundary may be omitted, and makes, joins and splits fields. For
/// tensors see metric_field.hpp.
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

/// Arrays of numbers, entity after entity; vertices are numbered from 0. Not modified.
template <std::signed_integral Index>
struct MeshArrays {
  int dimension = 2;                    ///< 2: elements are triangles; 3: tetrahedra
  std::span<const double> coordinates;  ///< [vertex * dimension + axis]
  std::span<const Index> elements;      ///< [element * (dimension + 1) + corner]
  // ---- Optional; missing references are 0 ----
  std::span<const std::int32_t> element_reference = {};  ///< [element]
  std::span<const Index> facets = {};                    ///< [facet * dimension + corner]
  std::span<const std::int32_t> facet_reference = {};    ///< [facet]
  std::span<const std::int32_t> vertex_reference = {};   ///< [vertex]
  std::string name = {};                                 ///< for messages
  /// In dimension 3: a surface alone, whose elements are triangles and whose facets are edges.
  bool is_surface = false;
};

/// Makes a mesh from these arrays. Given facets keep their order and come first, so their indices
/// are also valid for AnyMesh::required_edges (3D: required_triangles); facets found by
/// list_boundary() follow. Throws InputError, naming the array of the AnyMesh and the index, for
/// array lengths that do not fit, vertices that do not exist, and coordinates that are not finite;
/// adapt() or check_mesh() finds whether the mesh is valid. Index is int, long or long long. Thread
/// safety: one caller; runs on the executor.
template <std::signed_integral Index>
AnyMesh mesh_from_arrays(const runtime::Executor& executor, const MeshArrays<Index>& arrays);

/// Lists the facets of one element only, and those between elements of different references, that
/// the mesh does not list yet. Their reference is 0; their corners are oriented outwards from their
/// element, of two elements the one of the lower number. They are in the order of their elements.
/// Returns their number. Throws as above. Thread safety: one caller; runs on the executor.
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

/// A mesh, and the vertices of another one that it has kept, in their order.
struct JoinedVertices {
  AnyMesh mesh;
  std::vector<std::uint32_t> kept;
};

/// Joins vertices that are within a distance of each other, and facets and edges that become the
/// same: the first of them stays where it is, with its reference. Throws InputError
/// if two corners of an element or a facet are within that distance, or arrays do not fit together.
JoinedVertices join_vertices(AnyMesh mesh, double tolerance);

/// The values at vertices that were kept.
AnyField at_kept(const AnyField& field, const std::vector<std::uint32_t>& kept);

/// All fields of both, those of `first` first. Throws InputError unless they have the same
/// dimension and number of vertices.
AnyField joined(const AnyField& first, const AnyField& second);

/// Splits the fields of an AnyField: "NAME", or "NAME_1", "NAME_2", ... if there are several.
/// Throws InputError unless there are values for all vertices.
std::vector<NamedField> named_fields(const AnyField& field, const std::string& name);

/// The values [vertex] of the scalar field with this index, from 0. Throws InputError if it is not
/// one.
std::vector<double> scalars_of(const AnyField& field, std::size_t index = 0);

/// The same for a field of vectors.
template <int Dim>
std::vector<Vector<Dim>> vectors_of(const AnyField& field, std::size_t index = 0);

extern template AnyField vector_field(const std::vector<Vector<2>>&, const std::string&);
extern template AnyField vector_field(const std::vector<Vector<3>>&, const std::string&);
extern template std::vector<Vector<2>> vectors_of<2>(const AnyField&, std::size_t);
extern template std::vector<Vector<3>> vectors_of<3>(const AnyField&, std::size_t);

}  // namespace ductile::meshadapt
