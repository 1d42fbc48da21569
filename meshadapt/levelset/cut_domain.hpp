/// @file
/// CutDomain<Dim>: a mesh about to be cut: its elements by material, its listed facets and edges,
/// and what its vertices must stay on. A surface alone has Dim 2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/level_set.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// A listed edge of a 3D mesh, as seen from one of its ends.
struct ListedSpoke {
  VertexId from, to;
  std::uint32_t edge;
  friend auto operator<=>(const ListedSpoke&, const ListedSpoke&) = default;
};

template <int Dim>
struct CutDomain {
  const AnyMesh& any;
  FixedMesh<Dim> mesh;                     // of a surface it has no positions and shares
  std::vector<CutMaterial> materials;      // at least one
  std::vector<std::uint32_t> material_of;  // [element]
  std::vector<std::array<std::uint32_t, Dim + 1>> listed_of;  // [element][facet], 1 + the listed
                                                              // facet's index; 0: it is not listed
  std::vector<std::uint8_t> drops_facet;  // [listed facet] 1: it is left over from an earlier cut
  std::vector<std::uint8_t> drops_edge;   // [listed edge in 3D]
  std::vector<ListedSpoke> spokes;        // 3D: each listed edge twice, sorted
  std::vector<std::uint8_t> is_ridge;     // [edge]
  std::vector<std::uint8_t> is_fixed;     // [vertex] 1: it may not move

  bool is_split(ElementId element) const { return materials[material_of[element]].split; }

  /// Does a facet of an element lead out of its material?
  bool is_border(ElementId element, std::size_t facet) const {
    const ElementId other = mesh.neighbour_of[element][facet];
    return other == none || material_of[other] != material_of[element];
  }

  std::span<const ListedSpoke> spokes_of(VertexId vertex) const;
};

/// Throws InputError as cut() does for meshes and materials. Thread safety: one caller; runs on the
/// executor.
template <int Dim, int Space>
CutDomain<Dim> make_cut_domain(const runtime::Executor& executor, const AnyMesh& mesh,
                               const CutOptions& options);

extern template struct CutDomain<2>;
extern template struct CutDomain<3>;

}  // namespace ductile::meshadapt
