/// @file
/// BoundaryParts: what the steps of classify() know of the boundary and hand on to each other:
/// facets with their patches, what they share, noise and rounding.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "geometry/classify.hpp"
#include "geometry/facet_sides.hpp"
#include "geometry/reference_surface.hpp"
#include "geometry/rounding.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct BoundaryParts {
  /// The arguments of classify(); mesh and options must live as long.
  BoundaryParts(const runtime::Executor& executor, Mesh<Dim>& mesh,
                std::vector<TaggedFacet<Dim>> facets, const std::vector<ListedEdge>& edges,
                const MakeMeshOptions& options);

  const runtime::Executor& executor;
  Mesh<Dim>& mesh;
  const MakeMeshOptions& options;
  std::vector<TaggedFacet<Dim>> facets;
  double extent;               ///< of the mesh
  double tolerance;            ///< of flatness
  double hausdorff_tolerance;  ///< of what is not flat; 0 if nothing is to be smooth
  double least_turn;           ///< cosine of the angle from which on edges are ridges
  FacetSides<Dim> sides;
  std::unordered_map<SideKey, ListedEdge> listed;    ///< 3D
  const ReferenceSurface<Dim>* reference = nullptr;  ///< null where the mesh is its own
  std::vector<std::uint32_t> reference_sheets;       ///< [facet]; empty without a reference
  std::shared_ptr<Rounding<Dim>> rounding;           ///< null until it is known
  std::vector<Vector<Dim>> wide_normals;             ///< [facet], 0 if its own; empty if all are
  std::vector<std::uint8_t> kept;   ///< [vertex], whether facets there keep their shape
  std::vector<PatchId> plane_of;    ///< [facet], its patch before flat ones were joined
  std::vector<Vector<Dim>> places;  ///< [vertex], see levelled_places()

  /// By how much rounding may have moved what the boundary and curves are made of; 0 if they are
  /// precise. Sets `rounding`.
  double rounding_tolerance();
  /// Is a part near a plane or line only up to rounding?
  bool is_rough() const {
    return rounding && !(rounding->plane_of.empty() && rounding->line_of.empty());
  }

  /// The reference's sheet that a facet stands for; none if there is no such or no reference.
  std::uint32_t sheet_of(std::uint32_t facet) const {
    return reference_sheets.empty() ? none : reference_sheets[facet];
  }
  bool is_on_curved_sheet(std::uint32_t facet) const {
    return sheet_of(facet) != none && reference->is_smooth[sheet_of(facet)] != 0;
  }

  /// Do two facets turn little where they meet, or would they without noise?
  bool turns_little(std::uint32_t f, std::uint32_t g, SideKey key) const;
  /// Does a smooth patch have an edge here, or in 2D a corner, that fades out elsewhere?
  bool is_sharp(std::span<const FacetSide> both) const;
  /// The patches of the facets at a side, sorted.
  std::vector<PatchId> patches_at(SideKey key) const;
};

extern template struct BoundaryParts<2>;
extern template struct BoundaryParts<3>;

}  // namespace ductile::meshadapt
