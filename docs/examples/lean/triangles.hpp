/// @file
/// Triangulations that grow on one thread.
#pragma once

#include <cstdint>

#include "../plane.hpp"

namespace lean {

using example::outside, example::place_of, example::Point, example::TriangleId,
    example::Triangulation, example::VertexId;

/// A reach() that grants all triangles, because nothing else runs.
inline constexpr auto anywhere = [](TriangleId) { return true; };

inline TriangleId add_triangle(Triangulation& mesh) {
  mesh.corners_of.emplace_back();
  mesh.neighbours_of.emplace_back();
  return static_cast<TriangleId>(mesh.corners_of.size() - 1);
}

}  // namespace lean
