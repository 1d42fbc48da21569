/// @file
/// New numbers of the remaining entities of a mesh: vertices in order along a Hilbert curve through
/// the bounding box, elements in the order of their lowest vertices. An order lists the old numbers
/// of existing entities. None depends on the number of threads. Thread safety: one caller; runs on
/// the executor. All throw std::bad_alloc.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

using Ids = runtime::UnsetVector<std::uint32_t>;

/// Vertices that have elements in their lists, or a number from `unlisted` on.
template <int Dim, int Space>
Ids order_of_vertices(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                      VertexId unlisted);

/// The position of each old number, below `count`, in the order; uninitialised for missing ones.
Ids places_in(const runtime::Executor& executor, const Ids& order, std::size_t count);

/// Renumbers the corners of elements, to numbers below `vertex_count`, and orders the elements by
/// their lowest corners, stably.
template <int Dim, int Space>
Ids renumber_corners(const runtime::Executor& executor, Mesh<Dim, Space>& mesh,
                     const Ids& new_vertex, std::size_t vertex_count);

}  // namespace ductile::meshadapt
