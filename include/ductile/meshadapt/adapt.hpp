/// @file
/// adapt: makes every edge of a mesh about one unit long in a metric, by rounds of coarsening,
/// swapping, refining and smoothing. AnyMesh in, AnyMesh out; the dimension is found there.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/make_mesh_options.hpp"
#include "ductile/meshadapt/rules.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

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
  int iterations = 16;       ///< at most this many rounds of the four kernels, but for those on
                             ///< the way to a metric that is far from the mesh
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
  Rules rules = {};
  MakeMeshOptions make = {};
  /// Called on the calling thread after each step, many times a second in small meshes. If it
  /// returns false, adapt() throws Cancelled; what it throws itself, adapt() throws.
  std::function<bool(const AdaptProgress&)> progress = {};
};

/// Seconds and work of one kernel over the whole run.
struct KernelReport {
  double seconds = 0;
  std::size_t considered = 0, applied = 0, rounds = 0;
  /// Of `seconds`, those of its rounds (see RoundsReport); the rest went into looking for work.
  double conflict_seconds = 0, plan_seconds = 0, apply_seconds = 0, commit_seconds = 0;
  double wake_seconds = 0;
};

/// What adapt() did, how long it took, and what it has to say.
struct AdaptReport {
  int iterations = 0;
  bool converged = false;
  KernelReport coarsen, refine, swap, smooth;
  double setup_seconds = 0, renumber_seconds = 0, total_seconds = 0;
  /// Vertices of the input that could not leave their place: corners, and those of curved
  /// boundaries that keep their facets.
  std::size_t fixed_vertices = 0;
  /// Edges of the adapted mesh on curved boundaries that may change
  /// (MakeMeshOptions::hausdorff_tolerance), and those of them that are shorter than 1/sqrt 2.
  std::size_t curved_edges = 0, curved_edges_short = 0;
  /// Edges of the adapted mesh that are longer than Rules::long_edge, or shorter than
  /// Rules::short_edge, because required entities hold them: a long one belongs to a required
  /// facet, curve or element, so it may not be split; of a short one neither end may be moved onto
  /// the other, because one at least is required or belongs to such an entity. Remedies are sizes
  /// that come nearer to those of the required entities, or fewer of these.
  std::size_t held_long_edges = 0, held_short_edges = 0;
  /// How many times the input was adapted. Where check_adapted() finds something wrong with curved
  /// boundaries, it is adapted again, and facets near there are kept.
  int attempts = 1;
  bool checked = false;  ///< check_adapted() was asked, and the mesh is right
  std::vector<std::string> warnings;
  /// What the kernels were compiled for: "as built", "x86-64-v3" or "x86-64-v4". The library may
  /// hold them for several processors and uses the best that this one can run.
  std::string_view instructions = "as built";
};

/// A mesh and the metric at its vertices.
struct AdaptedMesh {
  AnyMesh mesh;
  AnyField metric;  ///< one symmetric field
  AdaptReport report;
};

/// Adapts `mesh` to `metric`, which has one symmetric positive definite tensor per vertex (see
/// metric_field.hpp to get one from a file); bounds on sizes hold before it is judged, so an
/// eigenvalue of 0 is fine with a largest size. With a deterministic executor the result depends on
/// nothing but the input and the last bits of the C library's exp() and log(), of which glibc has
/// one version for processors with AVX2 and one for others. Throws InputError for options that make
/// no sense and input that is not a valid mesh; Error if the elements that the metric asks for
/// would take more memory than options.memory_limit; Cancelled if options.progress asks for that;
/// std::bad_alloc if memory runs out,
/// std::length_error if there would be more entities than 32 bits count. Thread safety: any thread;
/// the work runs on the executor.
AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& metric,
                  const AdaptOptions& options = {});

}  // namespace ductile::meshadapt
