/// @file
/// Sizes: edge lengths without tensors: one for the whole mesh, others in regions, on boundaries,
/// near points, balls, boxes, curves and surfaces, growing with distance. Where several apply, the
/// finest wins.
///
/// @code
///   Sizes sizes{.elsewhere = 0.1};
///   sizes.add(Ball{{0.5, 0.5, 0.5}, 0.2}, 0.01);
///   sizes.add(Named{"wall"}, 0.005, {.grow = 1.2});
///   const AdaptedMesh adapted = adapt_to_sizes(executor, mesh, sizes);
/// @endcode
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

// ---- Places; in 2D the third coordinate is 0 or omitted ----

/// A ball of points within `radius` of the centre; a point if that is 0.
struct Ball {
  Vector<3> centre;
  double radius = 0;
};

/// A box between two opposite corners, parallel to the axes. In 2D the third axis is ignored.
struct AxisBox {
  Vector<3> low, high;
};

/// A chain of segments from each point to the next, or a single point.
struct Polyline {
  std::vector<Vector<3>> points;
};

/// Triangles, which need not be connected.
struct TriangleSurface {
  std::vector<Vector<3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of points
};

/// All entities of a dimension that carry this reference: elements of a region, facets of a
/// boundary or an interface, edges, vertices.
struct Referenced {
  int dimension = 0;  ///< 0, vertices; 1, edges; 2, triangles; 3, tetrahedra
  std::int32_t reference = 0;
};

/// All entities with a reference of this name (AnyMesh::names), of any dimension.
struct Named {
  std::string name;
};

using SizePlace = std::variant<Ball, AxisBox, Polyline, TriangleSurface, Referenced, Named>;

// ---- Sizes ----

/// How a size grows with the distance from its place.
struct SizeGrowth {
  /// Growth factor per unit of metric length, as in limit_gradation: at the distance d the size is
  /// size + d ln(grow). 1 or more; 0: the size applies at the place itself and nowhere else.
  double grow = 1.3;
  double largest = 0;   ///< the size grows up to this and then stays; 0: without end
  double distance = 0;  ///< instead of `grow`: it grows linearly to `largest` over this distance
};

/// A place, the size there, and its growth around it.
struct SizeSource {
  SizePlace place = {};
  double size = 0;
  SizeGrowth growth = {};
  std::string name = {};  ///< for messages, which otherwise say sources[7]
};

/// Sizes by places, without tensors; the finest at each point wins.
struct Sizes {
  /// Size where nothing finer applies; 0: the extent of the mesh. The size of a region replaces it
  /// there, finer or coarser; at a vertex of several regions, the finest.
  double elsewhere = 0;
  std::vector<SizeSource> sources = {};
  SizeBounds bounds = {};  ///< applied last; their anisotropy is ignored

  Sizes& add(SizePlace place, double size, SizeGrowth growth = {}) {
    sources.push_back({std::move(place), size, growth, {}});
    return *this;
  }
};

/// Evaluates the sizes at each vertex of the mesh: one scalar field. Takes n log n in vertices and
/// entities for each source. Throws InputError, naming the source, for sizes that are not from
/// 1e-75 to 1e75, invalid growth or places, references or names that the mesh does not have, and a
/// growing region in a mesh with an invalid element. The result does not depend on the number of
/// threads. Thread safety: any thread; runs on the executor.
AnyField size_field(const runtime::Executor& executor, const AnyMesh& mesh, const Sizes& sizes);

// ---- Bounds by reference ----

/// Bounds at the vertices of all entities of a dimension that carry a reference.
struct LocalSize {
  int dimension = 0;  ///< 0, vertices; 1, edges; 2, triangles; 3, tetrahedra
  std::int32_t reference = 0;
  double smallest = 0, largest = 0;  ///< 0: the bounds that apply elsewhere
  double hausdorff_tolerance = 0;    ///< Mmg's hausd; 0: none. No function here reads it
};

/// Reads Mmg's parameter file, NAME.mmg2d or NAME.mmg3d: the word Parameters, a count, and for each
/// entry reference, kind of entity (Vertex, Edge, Triangle, Tetrahedron or their plurals), hmin,
/// hmax and hausd; case is ignored, '#' starts a comment. Numbers of 0 or less mean nothing.
/// Settings for level sets (read_level_set_references()) are ignored, with a line in `warnings`.
/// Throws InputError
/// ("FILE:LINE: expected, found") for anything else. Thread safety: any thread.
std::vector<LocalSize> read_local_sizes(const std::filesystem::path& path,
                                        Warnings* warnings = nullptr);

/// Clamps the sizes that a metric, one symmetric field, asks for: at the vertices of the entities
/// to their bounds, at others to `elsewhere`. At a vertex of several entities those of the least
/// dimension count, as in Mmg, where boundaries override regions; among these, the finest bounds.
/// References that the mesh does not have are ignored. Throws InputError for a field that is not a
/// metric of the mesh, for bounds that bound_sizes() would not take, and for a dimension that is
/// not from 0 to that of the mesh. Thread safety: one caller; runs on the executor.
AnyField bound_sizes_locally(const runtime::Executor& executor, const AnyMesh& mesh,
                             const AnyField& metric, const std::vector<LocalSize>& local_sizes,
                             const SizeBounds& elsewhere = {});

}  // namespace ductile::meshadapt
