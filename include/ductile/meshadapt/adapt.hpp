/// @file
/// adapt: makes every edge of a mesh about one unit long in a metric, by rounds of coarsening,
/// swapping, refining and smoothing. It takes and returns an AnyMesh, which knows its dimension.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

struct Sizes;  // sizes.hpp

/// Time and work of one kernel over the whole run.
struct KernelReport {
  double seconds = 0;
  std::size_t considered = 0, applied = 0, rounds = 0;
  /// Parts of `seconds` spent in rounds (see RoundsReport); the rest was spent looking for work.
  double conflict_seconds = 0, plan_seconds = 0, apply_seconds = 0, commit_seconds = 0;
  double wake_seconds = 0;
};

/// Statistics, times and warnings of a run of adapt().
struct AdaptReport {
  int iterations = 0;
  bool converged = false;
  KernelReport coarsen, refine, swap, smooth;
  double setup_seconds = 0, renumber_seconds = 0, total_seconds = 0;
  /// Vertices of the input that could not move: corners, and those of curved boundaries that keep
  /// their facets.
  std::size_t fixed_vertices = 0;
  /// Edges of the adapted mesh on curved boundaries that may change
  /// (MakeMeshOptions::hausdorff_tolerance); how many of them are shorter than 1/sqrt 2.
  std::size_t curved_edges = 0, curved_edges_short = 0;
  /// Edges of the adapted mesh longer than Rules::long_edge, or shorter than Rules::short_edge,
  /// because of required entities. A long one belongs to a required facet, curve or element, so it
  /// may not be split; the ends of a short one may not be merged, because one at least is required
  /// or belongs to such an entity. Ask for sizes closer to those of the required entities, or
  /// require fewer.
  std::size_t held_long_edges = 0, held_short_edges = 0;
  /// How many times the input was adapted. If check_adapted() finds a fault at curved boundaries,
  /// it is adapted again, and facets near the fault are kept.
  int attempts = 1;
  bool checked = false;  ///< check_adapted() ran and found no fault
  std::vector<std::string> warnings;
  /// Instructions of the functions that take most of the time: "as built", or "x86-64-v4" if the
  /// library also contains them for AVX-512 and this processor has it.
  std::string_view instructions = "as built";
};

/// The kernels; kernels[number] has the name and report of each. All lists of kernels use it.
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
/// metric_field.hpp to get one from a file). Bounds on sizes are applied before the metric is
/// validated, so eigenvalues of 0 are allowed with a largest size. With a deterministic executor
/// the result depends only on the input and the last bits of the C library's exp() and log(); glibc
/// has different versions for processors with and without AVX2. Throws InputError for invalid
/// options or an invalid mesh; Error if the elements that the metric asks for would take more
/// memory than options.memory_limit; Cancelled if options.progress asks for that; std::bad_alloc if
/// memory runs out; std::length_error if there would be more entities than 32 bits can count.
/// Thread safety: any thread; the work runs on the executor.
AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& metric,
                  const AdaptOptions& options = {});

/// A mesh and a metric, one symmetric tensor at each of its vertices.
struct MeshWithMetric {
  AnyMesh mesh;
  AnyField metric;
};

/// What a MetricSource sees before a pass.
struct AdaptState {
  const runtime::Executor& executor;
  int pass;  ///< counts the metrics given so far; 0: the input is to be adapted
  const AnyMesh& input;
  /// The adapted mesh as it stands, with the metric that it was adapted to; made when first asked
  /// for. Not in pass 0.
  std::function<const MeshWithMetric&()> adapted;

  const AnyMesh& mesh() const { return pass == 0 ? input : adapted().mesh; }
};

/// Gives the metrics of an adaptation one after another: fixed ones, or sizes that are evaluated
/// anew on each mesh. adapt() asks it on the calling thread.
class MetricSource {
 public:
  virtual ~MetricSource() = default;
  /// The metric for the next pass, one symmetric tensor at each vertex of state.mesh(), which must
  /// stay until the next call; null if the mesh is final. Pass 0 comes again if adapt() starts over
  /// with the input, as it does where curved boundaries met; a source gives the same then.
  virtual const AnyField* next(const AdaptState& state) = 0;
};

/// adapt() to the metrics of a source, at most most_passes of them; then it warns and ends. Each
/// is bounded, validated and limited like the metric above, on the mesh that it is for; curved
/// boundaries are always measured from options.make.geometry, or from `mesh`. The report sums up
/// all passes; its iterations are those of the last. Exceptions of the source leave adapt(). Throws
/// InputError if the source has no metric for pass 0.
AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, MetricSource& source,
                  const AdaptOptions& options = {});
inline constexpr int most_passes = 100;  ///< from the input on

/// Adapts `mesh` to sizes given by places. Sizes are evaluated at vertices, so a coarse mesh
/// samples them poorly: the mesh is adapted again, to sizes evaluated on it, while at some vertex
/// they are below two thirds of those used before; at most five times in all. Throws as
/// size_field() and adapt() do. Thread safety: any thread; runs on the executor.
AdaptedMesh adapt_to_sizes(const runtime::Executor& executor, const AnyMesh& mesh,
                           const Sizes& sizes, const AdaptOptions& options = {});

}  // namespace ductile::meshadapt
