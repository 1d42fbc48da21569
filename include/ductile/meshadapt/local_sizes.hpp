/// @file
/// Bounds on sizes that hold at the entities of some references only, and Mmg's files of local
/// parameters, which say such.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

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
