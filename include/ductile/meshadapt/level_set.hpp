/// @file
/// cut(): cuts a mesh along the surface (2D: curve) where a function, known at the vertices, is 0.
/// A surface alone is cut along a curve through its edges. The surface becomes facets of the mesh,
/// and the elements on its two sides get references of their own. Vertices near the surface are
/// moved onto it, so that the new elements are not much worse than the old ones; adapt() improves
/// them. The surface has the topology of the zero of the function's linear interpolant, where a
/// value of 0 counts as positive. Results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// What becomes of the elements with one reference.
struct CutMaterial {
  std::int32_t reference = 0;
  bool split = true;  ///< false: they keep their reference, and the sign in them does not matter
  std::int32_t minus = 3, plus = 2;  ///< references of the two sides if they are split
};

struct CutOptions {
  double level = 0;             ///< the surface is where the value is this
  std::int32_t minus = 3;       ///< reference of elements with lower values
  std::int32_t plus = 2;        ///< reference of elements with higher values
  std::int32_t interface = 10;  ///< reference of the facets on the surface. Listed facets (3D: and
                                ///< edges) that have it already are left over from an earlier cut:
                                ///< those inside the mesh are dropped

  /// Empty: all elements are split into `minus` and `plus`. Otherwise each element's reference is
  /// that of a material, or of a side of one, into which it is taken back first.
  std::vector<CutMaterial> materials;

  /// Connected parts of either side that have less than this fraction of the volume of the mesh
  /// become part of the other side.
  double least_component = 0;

  /// The surface crosses edges where the function is 0 that has the given values and, at the
  /// vertices, the gradients recovered from them. False: where its linear interpolant is 0.
  bool curved = true;

  /// The level is changed until the elements of lower values have this volume (2D and surfaces:
  /// area) within 1e-6 of it; if no level gives that, there is a warning.
  std::optional<double> keep_volume;

  /// Cuts only the listed triangles of a mesh of tetrahedra: these get references by side, new
  /// edges between them get `interface`, and tetrahedra that have an edge there are divided but
  /// keep their references. References in `materials` are then those of triangles.
  bool boundary_only = false;
};

/// The place of a vertex of a cut mesh in the mesh before: (1 - t) a + t b. a == b for a vertex
/// that stayed where it was.
struct VertexOrigin {
  VertexId a = none, b = none;
  double t = 0;
  friend bool operator==(const VertexOrigin&, const VertexOrigin&) = default;
};

struct CutReport {
  double level = 0;                    ///< at which the mesh was cut
  double minus_volume = 0;             ///< of the elements with lower values, where they are split;
                                       ///< an area in 2D and on surfaces
  std::size_t interface_facets = 0;    ///< facets on the surface
  std::size_t cut_elements = 0;        ///< elements that were cut
  std::size_t moved_vertices = 0;      ///< vertices that were moved onto the surface
  std::size_t taken_vertices = 0;      ///< vertices the surface goes through where they are
  std::size_t removed_components = 0;  ///< see CutOptions::least_component
  double removed_volume = 0;
  bool on_surface = false;  ///< the interface is a curve on a surface alone, or on a boundary
  Warnings warnings;
};

/// A mesh that was cut. The vertices of the mesh before come first and keep their numbers.
struct CutMesh {
  AnyMesh mesh;
  std::vector<double> value;                ///< [vertex] value - level; exactly 0 on the surface
  std::vector<VertexOrigin> vertex_origin;  ///< [vertex]
  std::vector<ElementId> element_origin;    ///< [element] the one it is a part of
  std::vector<std::uint32_t> facet_origin;  ///< [listed facet] likewise; `none` on the surface
                                            ///< (of a surface alone, facets are edges)
  CutReport report;
};

/// Cuts a mesh where a function is CutOptions::level. Listed facets, edges, corners, required
/// entities and names stay; facets and edges are divided as the elements are. A vertex is moved
/// only along flat boundaries, interfaces and listed facets, and along straight listed edges. Where
/// it may not move, the surface is off by up to 8 % of an edge, 20 % around features smaller than
/// an element; elsewhere a flat surface is exact up to rounding. If
/// the level is met nowhere, all elements are on one side, and there is a warning. Throws
/// InputError, naming the entity, if the mesh is not valid (see make_fixed_mesh), the surface
/// crosses a required element, facet or edge, a value is missing or not finite, or a reference is
/// not in the table of materials. Thread safety: one caller; runs on the executor.
CutMesh cut(const runtime::Executor& executor, const AnyMesh& mesh, std::span<const double> values,
            const CutOptions& options = {});

/// A field at the vertices of the mesh before, at those of the cut mesh: linear along its edges.
/// Throws InputError unless it has a value for each. Thread safety of this and the following: one
/// caller; runs on the executor.
AnyField field_at_cut(const runtime::Executor& executor, const AnyField& field, const CutMesh& cut);

/// The same for a metric, one symmetric tensor for each vertex (see metric_of()): its logarithm is
/// linear.
AnyField metric_at_cut(const runtime::Executor& executor, const AnyField& metric,
                       const CutMesh& cut);

}  // namespace ductile::meshadapt
