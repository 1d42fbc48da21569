/// @file
/// adapt: makes every edge of a mesh about one unit long in a metric, by rounds of coarsening,
/// swapping, refining and smoothing. AnyMesh in, AnyMesh out; the dimension is found there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

struct Sizes;  // sizes.hpp

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

/// The kernels, and by number their names and reports. Whatever lists kernels goes by this table.
enum class Kernel : std::uint8_t { coarsen, refine, swap, smooth };
struct NamedKernel {
  const char* name;
  KernelReport AdaptReport::*report;
};
inline constexpr std::array<NamedKernel, 4> kernels{{{"coarsen", &AdaptReport::coarsen},
                                                     {"refine", &AdaptReport::refine},
                                                     {"swap", &AdaptReport::swap},
                                                     {"smooth", &AdaptReport::smooth}}};

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

/// Adapts `mesh` to sizes said by places. Sizes are evaluated at vertices, so a coarse mesh shows
/// little of them: the result is adapted to sizes evaluated there, and the result again while at
/// some vertex of it they ask for less than two thirds of what it was adapted to there; at most
/// five times in all. Curved boundaries are measured from options.make.geometry, or from `mesh`,
/// each time. The report is that of the last time, with the seconds and warnings of all; progress
/// is told of all. Throws as size_field() and adapt() do. Thread safety: any thread; runs on the
/// executor.
AdaptedMesh adapt_to_sizes(const runtime::Executor& executor, const AnyMesh& mesh,
                           const Sizes& sizes, const AdaptOptions& options = {});

}  // namespace ductile::meshadapt
