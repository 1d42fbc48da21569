/// @file
/// Extents of a mesh as people ask for them: its box, the length, area or volume of what has one
/// reference, and the smallest and largest angle; ridges of its boundary, and how far that is from
/// where it was.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/box.hpp"

namespace ductile::cli {

using Position = Vector<3>;
/// Where a vertex is; z is 0 in 2D.
Position position(const AnyMesh& mesh, std::size_t vertex);

/// The length, area or volume of a cell with two, three or four corners.
double measure(const AnyMesh& mesh, std::span<const std::uint32_t> corners);

/// The box of all vertices, of which a mesh has some.
Box<3> box_of(const AnyMesh& mesh);

struct Extents {
  struct Amount {
    std::size_t count = 0;
    double size = 0;  ///< length of edges, area of triangles, volume of tetrahedra
  };

  Box<3> box;
  std::array<std::map<std::int32_t, Amount>, 4> amount_of{};  ///< [dimension][reference]

  /// Degrees: in 2D between edges, in 3D between facets of an element (dihedral); 0 without any.
  double smallest_angle = 0, largest_angle = 0;

  /// The amount of all of one dimension.
  Amount total(std::size_t dimension) const;
};

/// Sums are made in the order of the mesh. Expects cells to name existing vertices.
Extents extents_of(const AnyMesh& mesh);

/// The number of edges, in 2D of vertices, where listed facets turn by an angle in degrees or more,
/// or where one ends or three meet.
std::size_t ridge_count(const AnyMesh& mesh, double angle);

/// The largest distance of listed facets from a geometry, at their corners and the middles of their
/// edges and of themselves; none if nothing is curved. Thread safety: one caller; runs on the
/// executor.
std::optional<double> distance_to(const runtime::Executor& executor, const AnyMesh& mesh,
                                  const Geometry& geometry);

}  // namespace ductile::cli
