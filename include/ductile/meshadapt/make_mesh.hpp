/// @file
/// From a mesh as it stands in a file to a Mesh<Dim> that can be adapted, and back. Making one
/// checks that the file's mesh is one: every index in range, every element with a volume, all
/// turned the same way, every facet shared by at most two elements, the boundary listed.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// How a Mesh is made from that of a file: what of its boundary may change.
struct MakeMeshOptions {
  bool complete_boundary =
      false;                   ///< give unlisted boundary facets reference 0, do not refuse them
  bool lock_boundary = false;  ///< treat every boundary and interface facet as required
  /// Hausdorff tolerance: how far curved boundaries, interfaces and the curves between them may be
  /// from a smooth model of the input, a length; 0: they keep the facets they have.
  double surface_tolerance = 0;
  /// Degrees, more than 0 and less than 90. Two facets whose normals differ by this angle or more
  /// meet in a ridge, two edges of a curve in a corner; both are kept. What turns by less is
  /// curved.
  double ridge_angle = 45;
  /// Where distances are measured from; null: from a model of this mesh. Wants a surface_tolerance,
  /// which must be the geometry's.
  std::shared_ptr<const Geometry> geometry = nullptr;
  /// Vertices at which curved boundaries keep the facets they have all the same. Indices, from 0.
  std::vector<std::uint32_t> keep_facets_at = {};
};

/// Classifies vertices and finds patches and curves; metrics are left unset, hosts are the element
/// numbers themselves. Vertices and elements keep their numbers. `neighbours` receives the element
/// neighbours. Warnings (reoriented, unused vertices and edges) are appended. Throws InputError
/// naming the entity, numbered from 1 as in the file, or an option that is out of range. Thread
/// safety: one caller; runs on the executor.
template <int Dim>
Mesh<Dim> make_mesh(const runtime::Executor& executor, const AnyMesh& any,
                    const MakeMeshOptions& options, Neighbours<Dim>& neighbours,
                    std::vector<std::string>& warnings);

/// What take_apart() gives.
struct MeshWithMetric {
  AnyMesh mesh;
  AnyField metric;  ///< at the vertices
};

/// The mesh as a file holds it: boundary and interface facets, curves, corners and required
/// entities with their references. What is gone is left out, and the rest numbered as renumber()
/// would number it. The mesh's arrays are given back as soon as they have been read, so that there
/// is less to hold at once. Thread safety: one caller; runs on the executor.
template <int Dim>
MeshWithMetric take_apart(const runtime::Executor& executor, Mesh<Dim> mesh);

}  // namespace ductile::meshadapt
