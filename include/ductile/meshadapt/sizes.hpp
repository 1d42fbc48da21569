/// @file
/// Sizes: how long edges should be, said without tensors. A size holds everywhere, others in
/// regions, on boundaries, near points, balls, boxes, curves and surfaces, from where they grow
/// with the distance. Where several hold, the finest one does.
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

// ---- Where a size holds. Of places in the plane, the third coordinate is 0 or left out ----

/// All that is at most `radius` away from its centre; with 0, a point.
struct Ball {
  Vector<3> centre;
  double radius = 0;
};

/// Between two opposite corners, along the axes. In the plane the third axis does not count.
struct AxisBox {
  Vector<3> low, high;
};

/// A chain of segments from each point to the next; of one point, that.
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

/// All that carry a reference of this name (AnyMesh::names), of whatever dimension.
struct Named {
  std::string name;
};

using SizePlace = std::variant<Ball, AxisBox, Polyline, TriangleSurface, Referenced, Named>;

// ---- Sizes ----

/// How a size grows with the distance from the place where it holds.
struct SizeGrowth {
  /// By this factor per unit of metric length, as limit_gradation lets sizes grow: at the distance
  /// d it is size + d ln(grow). 1 or more; 0: the size holds at the place itself and nowhere else.
  double grow = 1.3;
  double largest = 0;   ///< it grows up to this, which is then asked for at most; 0: without end
  double distance = 0;  ///< instead of `grow`: it grows evenly to `largest` over this distance
};

/// A place, the size there, and how sizes grow around it.
struct SizeSource {
  SizePlace place = {};
  double size = 0;
  SizeGrowth growth = {};
  std::string name = {};  ///< for messages, which otherwise say sources[7]
};

/// Sizes by places, without tensors; the finest that any place asks for holds.
struct Sizes {
  /// Where nothing finer is asked for; 0: the extent of the mesh. In a region that has a size of
  /// its own, that takes the place of this, finer or coarser; at a vertex of several, the finest.
  double elsewhere = 0;
  std::vector<SizeSource> sources = {};
  SizeBounds bounds = {};  ///< which hold in the end; their anisotropy says nothing here

  Sizes& add(SizePlace place, double size, SizeGrowth growth = {}) {
    sources.push_back({std::move(place), size, growth, {}});
    return *this;
  }
};

/// The size at each vertex of the mesh, one scalar field. Linear in vertices and entities, times a
/// logarithm, for each source. Throws InputError, naming the source, for sizes that
/// are not from 1e-75 to 1e75, growth or places that make no sense, and references or names that
/// the mesh does not have; for a mesh whose elements are none where a region grows. The result does
/// not depend on the number of threads. Thread safety: any thread; runs on the executor.
AnyField size_field(const runtime::Executor& executor, const AnyMesh& mesh, const Sizes& sizes);

// ---- Bounds by reference ----

/// Bounds at the vertices of all entities of a dimension that carry a reference.
struct LocalSize {
  int dimension = 0;  ///< 0, vertices; 1, edges; 2, triangles; 3, tetrahedra
  std::int32_t reference = 0;
  double smallest = 0, largest = 0;  ///< 0: those that hold elsewhere
  double hausdorff_tolerance = 0;    ///< Mmg's hausd; 0: none. No function here reads it
};

/// Reads a file of Mmg's, NAME.mmg2d or NAME.mmg3d: the word Parameters, a count, and so many times
/// reference, kind of entity (Vertex, Edge, Triangle, Tetrahedron or their plurals), hmin, hmax and
/// hausd; in any case of letters, '#' starts a comment. Numbers of 0 or less say nothing. What says
/// how level sets are cut is left out, with a line in `warnings` if that is given. Throws
/// InputError
/// ("FILE:LINE: expected, found") for anything else. Thread safety: any thread.
std::vector<LocalSize> read_local_sizes(const std::filesystem::path& path,
                                        Warnings* warnings = nullptr);

/// Clamps the sizes that a metric, one symmetric field, asks for: at the vertices of the entities
/// within their bounds, at others within `elsewhere`. At a vertex of several entities those of the
/// least dimension count, as in Mmg, where boundaries come before regions; of these the finest
/// bounds. A reference that the mesh does not have bounds nothing. Throws InputError for a field
/// that is no metric of the mesh, for bounds that bound_sizes() would not take, and for a dimension
/// that is not from 0 to that of the mesh. Thread safety: one caller; runs on the executor.
AnyField bound_sizes_locally(const runtime::Executor& executor, const AnyMesh& mesh,
                             const AnyField& metric, const std::vector<LocalSize>& local_sizes,
                             const SizeBounds& elsewhere = {});

}  // namespace ductile::meshadapt
