/// @file
/// Adjacency<Dim>: what lies beside what in a mesh: the elements around each vertex and the element
/// across each facet. It is made once from a mesh, in parallel; whatever asks for neighbours or for
/// the boundary takes it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/neighbours.hpp"

namespace ductile::meshadapt {

/// A facet of an element.
struct ElementFacet {
  ElementId element = none;
  int facet = 0;
};

template <int Dim>
struct Adjacency {
  std::span<const Corners<Dim>> corners_of;                  // [element]
  std::vector<std::uint32_t> first_around;                   // [vertex], and the end
  std::vector<ElementId> around;                             // see elements_of(); one more is there
  std::vector<std::array<ElementId, Dim + 1>> neighbour_of;  // [element][facet]; `none`, `crowded`

  /// The elements around a vertex, ascending.
  std::span<const ElementId> elements_of(VertexId vertex) const {
    return {&around[first_around[vertex]], &around[first_around[vertex + 1]]};
  }

  ElementId across(ElementId element, int facet) const {
    return neighbour_of[element][static_cast<std::size_t>(facet)];
  }

  /// Whether all of these are corners of an element.
  bool has_all(ElementId element, std::span<const VertexId> vertices) const;

  /// The first element that has these corners, and which of its facets they are; element `none`:
  /// there is none.
  ElementFacet find(const Facet<Dim>& corners) const;

  /// The facet as that of the element across; element `none`: there is none, or it is crowded.
  ElementFacet other_side(const ElementFacet& at) const;

  /// Whether there is no element of the same region on the other side; region_of may be empty.
  bool on_region_boundary(ElementId element, int facet,
                          std::span<const std::uint32_t> region_of) const;
};

/// Refers to the corners. Precondition: they are below vertex_count. Nearly linear; throws
/// std::bad_alloc, and std::length_error if lists have more than 2^32 entries.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
Adjacency<Dim> make_adjacency(const runtime::Executor& executor,
                              std::span<const Corners<Dim>> corners_of, std::size_t vertex_count);

/// A mesh, and its adjacency from when somebody first asks for it. Refers to both. Thread safety:
/// one thread.
template <int Dim>
class AdjacentMesh {
 public:
  AdjacentMesh(const runtime::Executor& executor, const AnyMesh& mesh)
      : executor_(executor), mesh_(mesh) {}

  const runtime::Executor& executor() const { return executor_; }
  const AnyMesh& mesh() const { return mesh_; }
  const std::vector<Corners<Dim>>& elements() const { return elements_in<Dim>(mesh_).vertices; }

  /// Precondition: the mesh has the vertices that its elements name.
  const Adjacency<Dim>& adjacency() const {
    if (!made_) made_ = make_adjacency<Dim>(executor_, elements(), mesh_.vertex_count());
    return *made_;
  }

 private:
  const runtime::Executor& executor_;
  const AnyMesh& mesh_;
  mutable std::optional<Adjacency<Dim>> made_;
};

extern template struct Adjacency<2>;
extern template struct Adjacency<3>;
extern template Adjacency<2> make_adjacency(const runtime::Executor&, std::span<const Corners<2>>,
                                            std::size_t);
extern template Adjacency<3> make_adjacency(const runtime::Executor&, std::span<const Corners<3>>,
                                            std::size_t);

}  // namespace ductile::meshadapt
