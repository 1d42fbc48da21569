/// @file
/// mesh_from_arrays: an AnyMesh from the arrays that a simulation has, coordinates and cells. The
/// boundary need not be given. What comes out of adaptation is arrays already: see AnyMesh.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>

#include "ductile/meshadapt/any_mesh.hpp"
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

}  // namespace ductile::meshadapt
