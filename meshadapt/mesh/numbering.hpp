/// @file
/// The numbers that what is left of a mesh gets: vertices in their order along a Hilbert curve
/// through the bounding box, elements in that of their lowest vertices. An order lists the old
/// numbers; what is gone is not in it. None depends on the number of threads.
/// Thread safety: one caller; runs on the executor. All throw std::bad_alloc.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

using Ids = runtime::UnsetVector<std::uint32_t>;

/// Vertices that have elements, as their lists say; those from `unlisted` on have some.
template <int Dim>
Ids order_of_vertices(const runtime::Executor& executor, const Mesh<Dim>& mesh, VertexId unlisted);

/// For each old number, below `count`, its place in the order; unset for those that are not in it.
Ids places_in(const runtime::Executor& executor, const Ids& order, std::size_t count);

/// Gives the corners of elements their new numbers, which are below `vertex_count`, and puts the
/// elements into order: by the lowest of their corners, those of one vertex by their old numbers.
template <int Dim>
Ids renumber_corners(const runtime::Executor& executor, Mesh<Dim>& mesh, const Ids& new_vertex,
                     std::size_t vertex_count);

}  // namespace ductile::meshadapt
