/// @file
/// FixedMesh<Dim>: a mesh with fields. It does not change, so it stores the volumes and neighbours
/// of elements and the elements of vertices; boundary facets need not be listed. It serves recovery
/// of derivatives, statistics and transfer of fields, and finite element programs. FixedMesh<2, 3>
/// is a surface alone: triangles in space.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// An immutable mesh; see the top of this file.
template <int Dim, int Space = Dim>
struct FixedMesh {
  // ---- Elements ----
  std::vector<Corners<Dim>> corners_of;                      // [element], positively oriented
  std::vector<double> volume_of;                             // [element], area of triangles
  std::vector<std::array<ElementId, Dim + 1>> neighbour_of;  // [element][facet], none outside

  // ---- Vertices; some may have no elements ----
  std::vector<Vector<Space>> position_of;  // [vertex]
  std::vector<double> share_of;            // [vertex], integral of its hat function
  std::vector<std::uint8_t> on_boundary;   // [vertex], 1 if it belongs to a facet without neighbour

  std::size_t element_count() const { return corners_of.size(); }
  std::size_t vertex_count() const { return position_of.size(); }

  /// The elements around a vertex, in ascending order.
  std::span<const ElementId> elements_of(VertexId vertex) const {
    return {&around[first_around[vertex]], &around[first_around[vertex + 1]]};
  }

  std::array<Vector<Space>, Dim + 1> points(ElementId element) const {
    std::array<Vector<Space>, Dim + 1> result;
    for (std::size_t i = 0; i <= Dim; ++i) result[i] = position_of[corners_of[element][i]];
    return result;
  }

  // ---- For elements_of ----
  std::vector<std::uint32_t> first_around;  // [vertex], and one past the last
  std::vector<ElementId> around;            // one more than is used, so that its end has an address
};

/// Takes the triangles of a mesh of dimension 2, the tetrahedra of one of dimension 3, and
/// reorients inverted ones. Throws InputError if there are none, one has no volume or an index is
/// out of range. The triangles of a surface alone are taken as they are, without an area if
/// their corners differ. Thread safety: one caller; runs on the executor.
template <int Dim, int Space = Dim>
FixedMesh<Dim, Space> make_fixed_mesh(const runtime::Executor& executor, const AnyMesh& mesh);

/// Gradients of the functions that are 1 at one corner of an element and 0 at the others.
template <int Dim>
std::array<Vector<Dim>, Dim + 1> hat_gradients(const std::array<Vector<Dim>, Dim + 1>& points);

/// Integral over the mesh of the piecewise linear function with these values at the vertices.
/// Throws InputError unless there is one for each.
template <int Dim>
double integral(const runtime::Executor& executor, const FixedMesh<Dim>& mesh,
                std::span<const double> value_of);

extern template FixedMesh<2> make_fixed_mesh(const runtime::Executor&, const AnyMesh&);
extern template FixedMesh<2, 3> make_fixed_mesh(const runtime::Executor&, const AnyMesh&);
extern template FixedMesh<3> make_fixed_mesh(const runtime::Executor&, const AnyMesh&);
extern template std::array<Vector<2>, 3> hat_gradients<2>(const std::array<Vector<2>, 3>&);
extern template std::array<Vector<3>, 4> hat_gradients<3>(const std::array<Vector<3>, 4>&);
extern template double integral(const runtime::Executor&, const FixedMesh<2>&,
                                std::span<const double>);
extern template double integral(const runtime::Executor&, const FixedMesh<3>&,
                                std::span<const double>);

}  // namespace ductile::meshadapt
