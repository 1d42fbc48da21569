/// @file
/// Part<Dim>: some elements of a moving mesh as a mesh of their own, whose boundary towards the
/// others, and whose facets of bodies, may not change; and its return after it was adapted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "move/moving_mesh.hpp"

namespace ductile::meshadapt {

/// References of the part, from 1 on, and what they stand for.
template <class Meaning>
class Codes {
 public:
  explicit Codes(std::vector<Meaning> meanings);
  std::int32_t code(const Meaning& meaning) const;
  const Meaning& operator[](std::int32_t code) const {
    return meanings_[static_cast<std::size_t>(code - 1)];
  }
  /// A reference that no code has.
  std::int32_t other() const { return static_cast<std::int32_t>(meanings_.size() + 1); }

 private:
  std::vector<Meaning> meanings_;  // ascending, each once
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

  /// Replaces the part in the mesh that it was taken from. origin_of, [vertex of the adapted part],
  /// is the vertex of the part that it is, or none.
  Renewals put_back(MovingMesh<Dim>& whole, const AdaptedMesh& adapted,
                    const std::vector<VertexId>& origin_of) const;

 private:
  using Element = std::pair<std::int32_t, std::uint32_t>;  // reference and body

  static std::vector<Element> kinds_of(const MovingMesh<Dim>& whole);
  /// Numbers of elements with all these vertices, in the part and outside.
  template <std::size_t N>
  std::pair<int, int> count_around(const std::array<VertexId, N>& vertices) const;
  template <std::size_t N>
  std::array<VertexId, N> local(std::array<VertexId, N> vertices) const;
  bool has_paths(std::span<const VertexId> vertices) const;

  PartNumbers number_vertices(const std::vector<VertexId>& origin_of, Renewal& renewal) const;
  void renew_lists(AnyMesh& any, const AnyMesh& adapted, const PartNumbers& numbers) const;
  void renew_elements(MovingMesh<Dim>& whole, const AnyMesh& adapted, const PartNumbers& numbers,
                      Renewal& renewal) const;
  void take_vertices();
  void take_facets();
  void take_cut();
  void take_edges();
  void take_marks();

  const MovingMesh<Dim>& whole_;
  const FixedMesh<Dim>& topology_;
  const std::vector<std::uint8_t>& is_chosen_;
  Codes<Element> element_codes_;
  Codes<std::int32_t> facet_codes_, edge_codes_;
  std::vector<VertexId> vertices_;
  std::vector<ElementId> elements_;
  std::vector<VertexId> local_of_;          // [vertex of the whole], or none
  std::vector<std::uint8_t> facet_passes_;  // [listed facet of the whole], may it change?
  std::vector<std::uint8_t> edge_passes_;   // [listed edge of the whole], in 3D
  std::vector<std::uint8_t> stays_;         // [vertex of the part], is it required?
  AnyMesh mesh_;
};

extern template class Part<2>;
extern template class Part<3>;

}  // namespace ductile::meshadapt
