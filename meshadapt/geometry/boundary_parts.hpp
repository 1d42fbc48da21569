/// @file
/// BoundaryParts: what the steps of classify() know of the boundary and hand on to each other:
/// facets with their patches, what they share, noise and rounding; and these steps.
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

/// What counts as flat, as noise and as smooth.
struct Tolerances {
  double flat;        ///< what is that close to a plane or line lies in it
  double surface;     ///< the Hausdorff tolerance; lower steps may be noise; 0: nothing is smooth
  double least_turn;  ///< cosine of the angle from which on edges are ridges
};

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
  double extent;  ///< of the mesh
  Tolerances within;
  FacetSides<Dim> sides;
  std::unordered_map<SideKey, ListedEdge> listed;    ///< 3D
  const ReferenceSurface<Dim>* reference = nullptr;  ///< null where the mesh is its own
  std::vector<std::uint32_t> reference_sheets;       ///< [facet]; empty without a reference
  std::shared_ptr<Rounding<Dim>> rounding;           ///< null until it is known
  std::vector<Vector<Dim>> noise_normals;  ///< [facet], see find_noise(); empty if there is none
  std::vector<std::uint8_t> kept;          ///< [vertex], whether facets there keep their shape
  std::vector<PatchId> plane_of;           ///< [facet], its patch before flat ones were joined
  std::vector<Vector<Dim>> places;         ///< [vertex], see denoise(); empty if there is no noise

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

  /// Where a vertex is without noise.
  const Vector<Dim>& place(VertexId v) const {
    return places.empty() ? mesh.site_of[v].position : places[v];
  }
  bool is_denoised(VertexId v) const { return place(v) != mesh.site_of[v].position; }
  bool is_noise(std::uint32_t facet) const {
    return !noise_normals.empty() && norm(noise_normals[facet]) > 0;
  }
  /// The unit normal that a facet has without noise, outwards from its element.
  Vector<Dim> direction(std::uint32_t facet) const;

  /// Do two facets turn little where they meet, or would they without noise?
  bool turns_little(std::uint32_t f, std::uint32_t g, SideKey key) const;
  /// Does a smooth patch have an edge here, or in 2D a corner, that fades out elsewhere?
  bool is_sharp(std::span<const FacetSide> both) const;
  /// Does a patch end at a side?
  bool ends_patch(std::span<const FacetSide> run) const {
    return run.size() != 2 || facets[run[0].facet].patch != facets[run[1].facet].patch ||
           is_sharp(run);
  }
  /// The patches of the facets at a side, sorted.
  std::vector<PatchId> patches_at(SideKey key) const;
};

// The steps, in their order. Thread safety: one caller; they run on the executor.

/// Sets mesh.patches and the facets' patches, and of smooth ones `kept`, `noise_normals` and
/// `plane_of`.
template <int Dim>
void classify_patches(BoundaryParts<Dim>& parts);

/// Makes patches of what is flat up to how precisely its coordinates were written, and measures
/// noise that their digits do not show: sets `rounding`. `across` is [facet][side], the next facet
/// or none.
template <int Dim>
void find_flat_parts(BoundaryParts<Dim>& parts,
                     std::span<const std::array<std::uint32_t, Dim>> across);

/// Sets `noise_normals`: [facet], the unit normal, outwards, that noise counts as having; 0 for
/// other facets. `beside` is [facet][side], the facet that has the side as well and may be of the
/// same patch, or none. Thin facets of level sets and of rounded coordinates turn by anything
/// against those around them; that is noise, no ridge, unless the surface itself turns there.
///
/// Noise is a facet that is lower than twice the surface tolerance and turns by much at a side, if
/// it rises by less than the tolerance from the mean normal, by area, of what is beside it up to
/// that distance, and if the surface is smooth there: if the normals do not cancel, as at the rim
/// of a thin plate, and if the means to either side of the facet, whichever way it is divided, turn
/// little against each other. Linear, but quadratic in how many facets are within that distance of
/// each other.
template <int Dim>
void find_noise(BoundaryParts<Dim>& parts, std::span<const std::array<std::uint32_t, Dim>> beside);

/// Finds where the boundary lies against itself, such as at closed cracks and touching bodies.
/// Marks in `kept` each boundary vertex that is within `distance` of a facet it is no corner of,
/// and the corners of that facet. Takes O(n log n).
template <int Dim>
void find_touching(BoundaryParts<Dim>& parts, double distance);

/// The edges of curves, which belong to no curve yet.
std::vector<CurveEdge> find_curve_edges(const BoundaryParts<3>& parts);

/// Sets `places`, of the vertices of noise in facets and curves: steps, needles and what rounding
/// made become the surface that they are on the mean, ridges stay. Vertices move by at most half of
/// the tolerance, towards where facets have the normals that they count as having (Sun, Rosin,
/// Martin & Langbein, "Fast and effective feature-preserving mesh denoising", IEEE TVCG 13, 2007),
/// and along the surface away from each other, by half as much. They stay in flat patches and on
/// curves. Where a curve turns by much, but not over twice the tolerance to both sides, that is
/// noise, too; elsewhere it has a corner, which stays. Linear.
template <int Dim>
void denoise(BoundaryParts<Dim>& parts, const std::vector<CurveEdge>& curve_edges);

/// Gives the edges their curves: sets mesh.curves and links_of. Looks at `places`.
void classify_curves(BoundaryParts<3>& parts, std::vector<CurveEdge>& edges);

/// Sets `crack_side` of patches that lie against another so that both could get the same edge, and
/// grow together: those that have a rim in common with another that encloses an area, in 2D both
/// ends; in 3D only where they meet in an acute angle. In 3D also of those with facets that lie
/// against facets of another in one plane, as on both sides of a closed crack, where they have two
/// vertices in common.
template <int Dim>
void mark_crack_sides(BoundaryParts<Dim>& parts);

/// The model of smooth patches and curves; null if there is none. Linear, times a logarithm.
template <int Dim>
std::shared_ptr<const Surface<Dim>> make_surface(const BoundaryParts<Dim>& parts,
                                                 std::span<const CurveEdge> edges);

/// Sets kind_of.class_dimension and entity_of from mesh.patches, curves and links_of.
template <int Dim>
void classify_vertices(const BoundaryParts<Dim>& parts);

extern template struct BoundaryParts<2>;
extern template struct BoundaryParts<3>;

}  // namespace ductile::meshadapt
