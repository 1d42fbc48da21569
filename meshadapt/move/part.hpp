/// @file
/// Part<Dim>: some elements of a moving mesh as a mesh of their own, whose boundary towards the
/// others, and whose facets of bodies, may not change; and its return after it was adapted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "move/moving_mesh.hpp"

namespace ductile::meshadapt {

/// An adapted part, the metric of its vertices, and where it comes from in the part.
template <int Dim>
struct AdaptedPart {
  AnyMesh mesh;
  std::vector<Site<Dim>> site_of;
  Origins origins;
};

/// New numbers of vertices: of those of the whole, or none, and of those of the adapted part.
struct PartNumbers {
  std::vector<VertexId> of_old, of_part;
};

/// What became of the entities of the whole mesh.
struct Renewals {
  Renewal vertices, elements;
};

template <int Dim>
class Part {
 public:
  /// The elements with a mark. `whole` and `topology`, which is whole's, are referred to.
  Part(const MovingMesh<Dim>& whole, const FixedMesh<Dim>& topology,
       const std::vector<std::uint8_t>& is_chosen);

  const AnyMesh& mesh() const { return mesh_; }
  AnyField metric() const;
  const std::vector<VertexId>& vertices() const { return vertices_; }   ///< numbers in the whole
  const std::vector<ElementId>& elements() const { return elements_; }  ///< numbers in the whole
  /// Does an element outside the part have this vertex of the part?
  bool is_shared(VertexId vertex) const;

  /// Replaces the part in the mesh that it was taken from.
  Renewals put_back(MovingMesh<Dim>& whole, const AdaptedPart<Dim>& adapted) const;

 private:
  /// Numbers of elements with all these vertices, in the part and outside.
  template <std::size_t N>
  std::pair<int, int> count_around(const std::array<VertexId, N>& vertices) const;
  template <std::size_t N>
  std::array<VertexId, N> local(std::array<VertexId, N> vertices) const;
  bool has_paths(std::span<const VertexId> vertices) const;

  void take_vertices();
  template <int N>
  void take_listed();
  void take_cut();
  void take_marks();
  PartNumbers number_vertices(const std::vector<VertexId>& origin_of, Renewal& renewal) const;
  template <int N>
  void renew_listed(AnyMesh& any, const AnyMesh& adapted, const PartNumbers& numbers) const;
  void renew_elements(MovingMesh<Dim>& whole, const AnyMesh& adapted, const PartNumbers& numbers,
                      Renewal& renewal) const;

  const MovingMesh<Dim>& whole_;
  const FixedMesh<Dim>& topology_;
  const std::vector<std::uint8_t>& is_chosen_;
  std::array<std::int32_t, 2> held_;  // references in the part of edges and triangles that stay
  std::vector<VertexId> vertices_;
  std::vector<ElementId> elements_;
  std::vector<VertexId> local_of_;                    // [vertex of the whole], or none
  std::array<std::vector<std::uint8_t>, 2> changes_;  // [listed edge, or triangle, of the whole],
                                                      // may it change?
  AnyMesh mesh_;
};

extern template class Part<2>;
extern template class Part<3>;

}  // namespace ductile::meshadapt
