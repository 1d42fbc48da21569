/// @file
/// Options of adapt(): the thresholds that the kernels share, what is kept of the boundary, and
/// limits of the run.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace ductile::meshadapt {

class Geometry;  // geometry.hpp

/// Thresholds for edges that are too short or too long and elements that are too bad, and for the
/// results of a change.
/// expect_rules() in adapt/adapt.cpp has the accepted values.
struct Rules {
  /// Edges shorter than this are collapsed.
  double short_edge = 0.70710678118654752;
  /// Edges longer than this are split.
  double long_edge = 1.41421356237309505;
  /// A collapse is refused if it makes an edge longer than this and, with extends_long_edges,
  /// longer than nearly the longest edge already around.
  double stretched_edge = 1.41421356237309505;
  bool extends_long_edges = true;  ///< see stretched_edge
  /// A collapse is refused if it makes an element worse than min(accepted_quality, kept_quality *
  /// worst quality in the old cavity): far from the metric, later changes still improve elements.
  double accepted_quality = 0.1;
  double kept_quality = 1;  ///< see accepted_quality
  /// An element worse than this may not be split into worse ones. On the sides of a layer that is
  /// one element thick each part need only keep layer_split_keeps of the quality, because there the
  /// layer causes the bad elements.
  double poor_quality = 0.001;
  double layer_split_keeps = 0.5;  ///< see poor_quality
  /// A split is refused if it makes an element worse than min(accepted_quality, split_keeps * worst
  /// quality before). For an edge longer than overlong_edge that bound is divided by the square of
  /// the ratio, except below poor_quality.
  double split_keeps = 0.3;
  double overlong_edge = 2;     ///< see split_keeps
  double shortest_split = 0.5;  ///< a split is refused if it makes an edge shorter than this
};

/// The exact surface of all facets with a reference, as a CAD kernel knows it.
struct SurfaceFunction {
  std::int32_t reference = 0;  ///< of facets; in 2D, of edges
  /// Returns the closest point of the surface to a nearby point; in 2D z is 0 and ignored in the
  /// result. The surface may extend beyond its ridges: a cylinder need not end. Must be
  /// deterministic, and return its own results unchanged up to rounding. Called by several threads
  /// at a time. Its exceptions leave the function that needed it.
  std::function<std::array<double, 3>(const std::array<double, 3>&)> closest;
  /// The function does not know the surface everywhere: where its result is not a number, or is
  /// farther away than the Hausdorff tolerance, the model of the mesh counts. Otherwise a result
  /// that is too far away is an error.
  bool approximate = false;
  /// With a gradation or curved_sizes: returns the tensor, stored as Metric is, that asks for
  /// elements at a point of the surface; 0 in directions in which it asks for nothing. Edges become
  /// shorter by a factor of 0.6 at most. Empty: sizes are those of the model alone. Called as
  /// `closest` is.
  std::function<std::array<double, 6>(const std::array<double, 3>&)> sizes = {};
};

/// How a Mesh is made from a file's mesh: which parts of its boundary may change.
struct MakeMeshOptions {
  bool complete_boundary = false;  ///< give unlisted boundary facets reference 0 instead of
                                   ///< refusing them
  bool lock_boundary = false;      ///< treat every boundary and interface facet as required
  /// Hausdorff tolerance: the largest distance of curved boundaries, interfaces and the curves
  /// between them from a smooth model of the input, a length. 0: they keep their facets.
  double hausdorff_tolerance = 0;
  /// Ridge angle in degrees, more than 0 and less than 90. Two facets whose normals differ by this
  /// angle or more meet in a ridge, two edges of a curve in a corner; both are kept. Smaller angles
  /// are treated as curved.
  double ridge_angle = 45;
  /// The surface that distances are measured from; null: a model of this mesh. Requires a
  /// hausdorff_tolerance equal to the geometry's.
  std::shared_ptr<const Geometry> geometry = nullptr;
  /// Surfaces given by functions: new and moved vertices of curved boundaries lie on them instead
  /// of the model. Not allowed with a geometry, which has its own.
  std::vector<SurfaceFunction> functions = {};
  /// Vertices, from 0, at which curved boundaries keep their facets regardless.
  std::vector<std::uint32_t> keep_facets_at = {};
};

/// The last step and the state of the mesh; passed to AdaptOptions::progress.
struct AdaptProgress {
  const char* step = "";  ///< "coarsen", "refine", "swap", "smooth", ...
  int iteration = 0;
  std::size_t changes = 0;
};

/// Options of adapt(), which refuses invalid ones: iterations below 0, bounds on sizes that are
/// neither 0 nor from 1e-75 to 1e75, a smallest size above the largest, a gradation between 0 and 1
/// or not finite, rules that are negative, above 1e6 or not numbers, or a long_edge that is not
/// longer than short_edge.
struct AdaptOptions {
  int iterations = 16;       ///< most rounds of the four kernels; adaptations to intermediate
                             ///< metrics do not count
  double smallest_size = 0;  ///< smallest edge length that may be asked for; 0: no bound
  double largest_size = 0;   ///< largest edge length that may be asked for; 0: no bound
  /// sizes grow by at most this factor per unit of metric length (see limit_gradation), including
  /// from the sizes that make.hausdorff_tolerance allows on curved boundaries; 0 or less: no limit.
  /// Mmg's default is 1.3
  double gradation = 0;
  bool curved_sizes =
      /// bounds sizes on curved boundaries by what make.hausdorff_tolerance allows even without a
      /// gradation; sizes grow from there by 1.3, or by the given factor if gradation is below 0.
      /// With coarsest_metric() they come from curvature alone, as with Mmg's -A
      false;
  /// sizes at required facets, edges and elements (with make.lock_boundary: at all facets) are
  /// their actual sizes, whatever metric and bounds ask for; away from them sizes change by at most
  /// this factor per unit of metric length. 0 or less: the metric's. Mmg's default is 2.3
  double required_gradation = 0;
  std::size_t memory_limit = 0;  ///< bytes that adapt() may take; metrics with more elements than
                                 ///< certainly fit are refused beforehand; 0: no limit
  bool thorough = false;    ///< better elements and lengths for more time (docs/performance.md)
  bool by_colours = false;  ///< the published method: collapses, swaps and moves run class by class
                            ///< of a colouring of vertices, and lists change by deferred updates.
                            ///< Valid and deterministic too, but slower
  bool move = true;         ///< smooth vertices
  bool swap = true;         ///< swap edges and faces
  bool insert = true;       ///< split and collapse edges
  bool approach_only = false;  ///< brings sizes near the metric in at most `iterations` rounds
                               ///< without improving elements: for a mesh that will be adapted
                               ///< again
  Rules rules = {};
  MakeMeshOptions make = {};
  /// Called on the calling thread after each step, many times a second for small meshes. If it
  /// returns false, adapt() throws Cancelled; its exceptions leave adapt().
  std::function<bool(const AdaptProgress&)> progress = {};
};

}  // namespace ductile::meshadapt
