/// @file
/// What adapt() is told beside the metric: the thresholds that the kernels share, what of the
/// boundary is kept, and how far to go.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace ductile::meshadapt {

class Geometry;  // geometry.hpp

/// What is too short, too long or too bad, and what a change may make of it. expect_rules() in
/// adapt/adapt.cpp says which values are accepted.
struct Rules {
  /// Edges shorter than this are collapsed.
  double short_edge = 0.70710678118654752;
  /// Edges longer than this are split.
  double long_edge = 1.41421356237309505;
  /// A collapse is refused if it makes an edge longer than this and, with extends_long_edges,
  /// longer than nearly the longest edge that there is around already.
  double stretched_edge = 1.41421356237309505;
  bool extends_long_edges = true;  ///< see stretched_edge
  /// A collapse is refused if it makes an element worse than min(accepted_quality, kept_quality *
  /// worst quality in the old cavity): far from the metric, good elements are still to come.
  double accepted_quality = 0.1;
  double kept_quality = 1;  ///< see accepted_quality
  /// An element worse than this may not be split into worse ones. On the sides of a layer that is
  /// one element thick each part need only keep layer_split_keeps of the quality, because there the
  /// layer is why elements are bad.
  double poor_quality = 0.001;
  double layer_split_keeps = 0.5;  ///< see poor_quality
  /// A split is refused if it makes an element worse than min(accepted_quality, split_keeps * worst
  /// quality before). For edges longer than overlong_edge that bound falls by the square of how
  /// much longer they are, also below poor_quality.
  double split_keeps = 0.3;
  double overlong_edge = 2;     ///< see split_keeps
  double shortest_split = 0.5;  ///< a split is refused if it makes an edge shorter than this
};

/// What all facets of a reference truly lie on, as a CAD kernel knows it.
struct SurfaceFunction {
  std::int32_t reference = 0;  ///< of facets, edges in 2D
  /// The closest point of the surface to a point that is near it; z is 0 in 2D, and does not count
  /// in the result. It may go on beyond its ridges: a cylinder need not end. Must be the same
  /// whenever it is asked, and its own result up to rounding if it is asked for that. Called by
  /// several threads at a time. What it throws comes out of the call that it was needed for.
  std::function<std::array<double, 3>(const std::array<double, 3>&)> closest;
};

/// How a Mesh is made from that of a file: what of its boundary may change.
struct MakeMeshOptions {
  bool complete_boundary =
      false;                   ///< give unlisted boundary facets reference 0, do not refuse them
  bool lock_boundary = false;  ///< treat every boundary and interface facet as required
  /// Hausdorff tolerance: how far curved boundaries, interfaces and the curves between them may be
  /// from a smooth model of the input, a length; 0: they keep the facets they have.
  double hausdorff_tolerance = 0;
  /// Degrees, more than 0 and less than 90. Two facets whose normals differ by this angle or more
  /// meet in a ridge, two edges of a curve in a corner; both are kept. What turns by less is
  /// curved.
  double ridge_angle = 45;
  /// Where distances are measured from; null: from a model of this mesh. Wants a
  /// hausdorff_tolerance, which must be the geometry's.
  std::shared_ptr<const Geometry> geometry = nullptr;
  /// Surfaces that are known by functions: new and moved vertices of curved boundaries lie on them,
  /// and not on the model. Not with a geometry, which has its own.
  std::vector<SurfaceFunction> functions = {};
  /// Vertices at which curved boundaries keep the facets they have all the same. Indices, from 0.
  std::vector<std::uint32_t> keep_facets_at = {};
};

/// What was done last and how the mesh stands; passed to AdaptOptions::progress.
struct AdaptProgress {
  const char* step = "";  ///< "coarsen", "refine", "swap", "smooth", ...
  int iteration = 0;
  std::size_t changes = 0;
};

/// adapt() refuses options that make no sense: iterations below 0, bounds on sizes that are neither
/// 0 nor from 1e-75 to 1e75, a smallest size above the largest, a gradation between 0 and 1 or not
/// finite, rules that are negative, above 1e6 or no numbers, or that split what they collapse.
struct AdaptOptions {
  int iterations = 16;       ///< at most this many rounds of the four kernels; those on the way
                             ///< to a metric that is far from the mesh do not count
  double smallest_size = 0;  ///< no edge length below this is asked for; 0: no bound
  double largest_size = 0;   ///< no edge length above this is asked for; 0: no bound
  double gradation = 0;      ///< sizes grow by at most this factor per unit of metric length (see
                             ///< limit_gradation), from what make.hausdorff_tolerance allows on
                             ///< curved boundaries; 0 or less: as given. Mmg's default is 1.3
  bool curved_sizes =
      false;  ///< sizes on curved boundaries are bounded by what
              ///< make.hausdorff_tolerance allows without a gradation, too; they grow
              ///< from there by a factor of 1.3, or as given with one below 0. With
              ///< coarsest_metric() they come from curvature alone, as with Mmg's -A
  double required_gradation = 0;  ///< sizes at required facets, edges and elements, and at all
                                  ///< facets with make.lock_boundary, are those that these have,
                                  ///< whatever metric and bounds ask for; from there they grow, or
                                  ///< fall, by at most this factor per unit of metric length; 0 or
                                  ///< less: as given. Mmg's default is 2.3
  std::size_t memory_limit =
      0;                    ///< bytes that adapt() may take; metrics that ask for more elements
                            ///< than certainly fit are refused before the work; 0: no limit
  bool thorough = false;    ///< better elements and lengths for more time (docs/performance.md)
  bool by_colours = false;  ///< as published: collapses, swaps and moves run class by class of a
                            ///< colouring of vertices, and they and splits change lists by deferred
                            ///< updates. Valid and deterministic too, but slower
  bool move = true;         ///< smooth vertices
  bool swap = true;         ///< swap edges and faces
  bool insert = true;       ///< split and collapse edges
  bool approach_only = false;  ///< brings sizes near the metric, by at most `iterations` rounds,
                               ///< and leaves elements as these leave them: for a mesh that is to
                               ///< be adapted once more
  Rules rules = {};
  MakeMeshOptions make = {};
  /// Called on the calling thread after each step, many times a second in small meshes. If it
  /// returns false, adapt() throws Cancelled; what it throws itself, adapt() throws.
  std::function<bool(const AdaptProgress&)> progress = {};
};

}  // namespace ductile::meshadapt
