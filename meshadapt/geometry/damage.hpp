/// @file
/// Damage: where the boundary of an adapted mesh crosses itself or is not connected as it was.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/adjacency.hpp"
#include "mesh/box.hpp"

namespace ductile::meshadapt {

/// Boxes around the places of the damage, and some others; none if it cannot be told where it is.
/// Precondition: check_mesh() finds no index of `after` out of range. A logarithm more than linear
/// in the meshes. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<Box<Dim>> damaged_places(const AdjacentMesh& before, const AdjacentMesh& after);

/// The vertices of boundary facets that are no farther than this, along each axis, from one of the
/// places; sorted. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<std::uint32_t> boundary_vertices_near(const AdjacentMesh& mesh,
                                                  const std::vector<Box<Dim>>& places,
                                                  double distance);

}  // namespace ductile::meshadapt
