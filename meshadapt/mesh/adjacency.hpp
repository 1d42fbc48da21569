/// @file
/// Adjacency<Dim>: the elements around each vertex and the element across each facet. It is made
/// once per mesh, in parallel, and used by all code that needs neighbours or the boundary.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/neighbours.hpp"

namespace ductile::meshadapt {

/// The elements around each vertex.
struct VertexElements {
  std::vector<std::uint32_t> first_around;  // [vertex], and one past the last
  std::vector<ElementId> around;            // one more than is used, so that its end has an address

  /// The elements around a vertex, ascending.
  std::span<const ElementId> elements_of(VertexId vertex) const {
    return {&around[first_around[vertex]], &around[first_around[vertex + 1]]};
  }
};

template <int Dim>
struct Adjacency : VertexElements {
  std::span<const Corners<Dim>> corners_of;                  // [element]
  std::vector<std::array<ElementId, Dim + 1>> neighbour_of;  // [element][facet]; `none`, `crowded`

  ElementId across(ElementId element, int facet) const {
    return neighbour_of[element][static_cast<std::size_t>(facet)];
  }

  /// The first element with these corners, and the number of the facet; element `none` if there is
  /// none.
  ElementFacet find(const Facet<Dim>& corners) const;

  /// The facet as seen from the element across; element `none` if there is none, or it is crowded.
  ElementFacet other_side(const ElementFacet& at) const;

  /// Is this the element of lowest number that has the facet?
  bool is_first(const ElementFacet& at) const;

  /// Is there no element of the same region across? region_of may be empty.
  bool on_region_boundary(ElementId element, int facet,
                          std::span<const std::uint32_t> region_of) const;
};

/// Lists the elements around each vertex. Precondition: corners are below vertex_count. Nearly
/// linear; throws std::bad_alloc, and std::length_error if lists have more than 2^32 entries.
/// Thread safety of this and the following: one caller; runs on the executor.
template <int Dim>
VertexElements list_elements(const runtime::Executor& executor,
                             std::span<const Corners<Dim>> corners_of, std::size_t vertex_count);

/// Makes an adjacency that owns the lists and refers to the corners.
template <int Dim>
Adjacency<Dim> make_adjacency(const runtime::Executor& executor,
                              std::span<const Corners<Dim>> corners_of, VertexElements lists);

/// A mesh with its adjacency, made when first asked for and kept. Refers to executor and mesh.
/// Precondition of asking: the mesh has this dimension, and its elements name existing vertices.
/// Thread safety: one caller, outside of loops; any thread may read what is returned.
class AdjacentMesh {
 public:
  AdjacentMesh(const runtime::Executor& executor, const AnyMesh& mesh)
      : executor_(executor), mesh_(mesh) {}

  const runtime::Executor& executor() const { return executor_; }
  const AnyMesh& mesh() const { return mesh_; }

  /// The elements around each vertex; takes less than half the time of the whole adjacency.
  template <int Dim>
  const VertexElements& lists() const;
  template <int Dim>
  const Adjacency<Dim>& adjacency() const;

 private:
  template <int Dim>
  std::optional<Adjacency<Dim>>& kept() const {
    return std::get<std::optional<Adjacency<Dim>>>(kept_);
  }

  const runtime::Executor& executor_;
  const AnyMesh& mesh_;
  mutable std::optional<VertexElements> lists_;  // moved into the adjacency once there is one
  mutable std::tuple<std::optional<Adjacency<2>>, std::optional<Adjacency<3>>> kept_;
};

extern template struct Adjacency<2>;
extern template struct Adjacency<3>;

}  // namespace ductile::meshadapt
