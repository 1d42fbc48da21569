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

struct MakeMeshOptions {
  bool complete_boundary =
      false;                   ///< give unlisted boundary facets reference 0, do not refuse them
  bool lock_boundary = false;  ///< treat every boundary and interface facet as required
  /// How far curved boundaries, interfaces and the curves between them may be from where they were,
  /// a length; 0: they keep the facets they have.
  double surface_tolerance = 0;
  /// Facets, or edges of a curve, that turn by as many degrees where they meet meet at a ridge, or
  /// a corner, which stays. Those that turn by less are curved. More than 0, less than 90.
  double ridge_angle = 45;
  /// What curved boundaries are like, if not what they are like in the mesh: distances are measured
  /// from it. With a surface_tolerance, which is the geometry's.
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
