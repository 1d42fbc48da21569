/// @file
/// Damage: where the boundary of an adapted mesh crosses itself or is not connected as it was.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/boundary_surface.hpp"
#include "mesh/box.hpp"

namespace ductile::meshadapt {

/// Boxes around the places of the damage, and some others; none if it cannot be told where it is.
/// `from` is of `before`; the boundary of `after` is listed. Precondition: check_mesh() finds no
/// index of `after` out of range. A logarithm more than linear in the meshes.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<Box<Dim>> damaged_places(const runtime::Executor& executor, const AnyMesh& before,
                                     const AnyMesh& after, BoundaryFrom from);

/// The vertices of boundary facets that are no farther than this, along each axis, from one of the
/// places; sorted. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<std::uint32_t> boundary_vertices_near(const runtime::Executor& executor,
                                                  const AnyMesh& mesh, BoundaryFrom from,
                                                  const std::vector<Box<Dim>>& places,
                                                  double distance);

extern template std::vector<Box<2>> damaged_places(const runtime::Executor&, const AnyMesh&,
                                                   const AnyMesh&, BoundaryFrom);
extern template std::vector<Box<3>> damaged_places(const runtime::Executor&, const AnyMesh&,
                                                   const AnyMesh&, BoundaryFrom);
extern template std::vector<std::uint32_t> boundary_vertices_near(const runtime::Executor&,
                                                                  const AnyMesh&, BoundaryFrom,
                                                                  const std::vector<Box<2>>&,
                                                                  double);
extern template std::vector<std::uint32_t> boundary_vertices_near(const runtime::Executor&,
                                                                  const AnyMesh&, BoundaryFrom,
                                                                  const std::vector<Box<3>>&,
                                                                  double);

}  // namespace ductile::meshadapt
