/// @file
/// adapt() after its arguments are checked: makes a mesh, runs an Adapter on it, takes it apart.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapt/adapt_mesh.hpp"
#include "adapt/adapter.hpp"
#include "adapt/held_edges.hpp"
#include "adapt/rescue.hpp"
#include "adapt/take_apart.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/process.hpp"
#include "geometry/curvature.hpp"
#include "geometry/flat_noise.hpp"
#include "geometry/make_mesh.hpp"
#include "mesh/wording.hpp"
#include "metric/demand.hpp"
#include "metric/mesh_gradation.hpp"
#include "metric/required_sizes.hpp"
#include "operators/round_boundary.hpp"

namespace ductile::meshadapt {

namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The limits of a metric, and the warnings about it.
struct SizeLimits {
  const AdaptOptions& options;
  const std::string& name;  ///< of the metric
  std::vector<std::string>& warnings;
};

/// The factor by which sizes may grow; 0 if there is no limit.
double growth_of(const AdaptOptions& options) {
  constexpr double from_curves = 1.3;
  return options.curved_sizes && options.gradation == 0 ? from_curves
                                                        : std::max(options.gradation, 0.0);
}
bool limits_growth(const AdaptOptions& options) {
  return options.gradation > 0 || options.curved_sizes;
}

template <int Dim>
void limit_growth(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                  const SizeLimits& limits, std::vector<Metric<Dim>>& metric_of) {
  const auto& [options, name, warnings] = limits;
  if (mesh.surface) bound_curved_sizes(executor, mesh, options.make.hausdorff_tolerance, metric_of);
  const double factor = growth_of(options);
  if (factor == 0) return;
  const auto report = limit_gradation(executor, metric_of, mesh, {.factor = factor});
  if (!report.converged)
    warnings.push_back(name + ": sizes still grow faster than asked for in places, after " +
                       std::to_string(report.sweeps) + " sweeps over the edges");
}

/// Makes the metrics keep the sizes and the growth that the options allow.
template <int Dim>
void limit_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, const SizeLimits& limits,
                 std::vector<Metric<Dim>>& metric_of) {
  const AdaptOptions& options = limits.options;
  const SizeBounds bounds{options.smallest_size, options.largest_size};
  bound_sizes(executor, metric_of, bounds);
  if (limits_growth(options)) {
    limit_growth(executor, mesh, limits, metric_of);
    bound_sizes(executor, metric_of, bounds);  // intersections may be finer than the metrics
  }
  if (options.required_gradation > 0 &&
      !take_required_sizes(executor, mesh, options.required_gradation, metric_of).converged)
    limits.warnings.push_back(limits.name +
                              ": sizes still differ more than asked for from required ones");
}

/// The metrics of the field, limited.
template <int Dim>
std::vector<Metric<Dim>> metrics_of(const runtime::Executor& executor, const AnyField& field,
                                    const Mesh<Dim>& mesh, const AdaptOptions& options,
                                    std::vector<std::string>& warnings) {
  auto metric_of = runtime::make_vector<Metric<Dim>>(executor, field.vertex_count);
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    std::copy_n(&field.values[v * Metric<Dim>::size], Metric<Dim>::size, metric_of[v].m.begin());
  });
  limit_sizes(executor, mesh, {options, field.name, warnings}, metric_of);
  return metric_of;
}

/// Throws unless the elements that the metric asks for can be numbered and fit in memory.
template <int Dim>
void expect_possible(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                     const std::vector<Metric<Dim>>& metric_of, const std::string& name,
                     const AdaptOptions& options) {
  if (!options.insert) return;
  constexpr int enough_to_refine = 6;
  const double elements =
      complexity_of_demand(executor, mesh, metric_of) / complexity_of_elements(Dim, 1);
  const double least = options.make.lock_boundary ? 0 : least_elements(executor, mesh, metric_of);
  expect_countable(name, Dim, std::max(elements, least));
  const std::size_t limit =
      options.memory_limit > 0 ? options.memory_limit : runtime::most_memory();
  if (limit > 0 && options.iterations >= enough_to_refine)
    expect_room(name, Dim, std::max(elements, least), limit);
}

template <int Dim>
std::size_t fixed_vertices(const runtime::Executor& executor, const Mesh<Dim>& mesh) {
  const auto is_fixed = [&](std::size_t v) {
    return std::size_t{mesh.kind_of[v].class_dimension == 0 &&
                       mesh.vertex_alive(static_cast<VertexId>(v))};
  };
  return runtime::parallel_reduce(executor, mesh.vertex_slots(), std::size_t{0}, is_fixed,
                                  std::plus<>());
}

/// The vertices of a higher number to which edges of smooth patches lead from v.
template <int Dim>
void find_curved_edges_up(const Mesh<Dim>& mesh, VertexId v, std::vector<VertexId>& higher) {
  higher.clear();
  for (const ElementId e : mesh.elements_of.of(v))
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (!mesh.patches[mesh.patches_of[e][i]].smooth || mesh.corners_of[e][i] == v) continue;
      for (const VertexId w : facet_of<Dim>(mesh.corners_of[e], static_cast<int>(i)))
        if (w > v) higher.push_back(w);
    }
  std::sort(higher.begin(), higher.end());
  higher.erase(std::unique(higher.begin(), higher.end()), higher.end());
}

template <int Dim>
void count_curved_edges(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                        AdaptReport& report) {
  if (!mesh.surface) return;
  struct Count {
    std::size_t all = 0, shorter = 0;
  };
  runtime::PerThread<std::vector<VertexId>> higher(executor);
  const auto count_at = [&](std::size_t v) {
    const auto from = static_cast<VertexId>(v);
    std::vector<VertexId>& ends = higher.mine();
    find_curved_edges_up(mesh, from, ends);
    const auto is_short = [&](VertexId to) { return mesh.length(from, to) < std::sqrt(0.5); };
    const auto shorter = std::count_if(ends.begin(), ends.end(), is_short);
    return Count{ends.size(), static_cast<std::size_t>(shorter)};
  };
  const Count total = runtime::parallel_reduce(executor, mesh.vertex_slots(), Count{}, count_at,
                                               [](const Count& a, const Count& b) {
                                                 return Count{a.all + b.all, a.shorter + b.shorter};
                                               });
  report.curved_edges = total.all;
  report.curved_edges_short = total.shorter;
}

/// An adapted mesh, and whether its boundary may have met itself on the way.
struct Attempt {
  AdaptedMesh adapted;
  bool may_meet;
  bool has_short;  ///< see has_short_facets()
};

template <int Dim>
bool has_crack_sides(const Mesh<Dim>& mesh) {
  return std::any_of(mesh.patches.begin(), mesh.patches.end(),
                     [](const Patch<Dim>& patch) { return patch.crack_side; });
}

/// Adapts. If the result is worse than the input, restores the input.
template <int Dim>
void run(std::optional<Adapter<Dim>>& adapter, const auto& set_up) {
  using Outcome = typename Adapter<Dim>::Outcome;
  adapter->run();
  if (adapter->outcome() == Outcome::better_mended) {
    set_up();
    adapter->mend();
  }
  if (adapter->outcome() == Outcome::better_left) {
    set_up();
    adapter->report().converged = true;
  }
}

template <int Dim>
Neighbours<Dim> neighbours_of(const runtime::Executor& executor, const Mesh<Dim>& mesh) {
  Neighbours<Dim> neighbours;
  runtime::FreshMemory fresh;
  neighbours.resize_for_overwrite(mesh.element_slots(), fresh);
  fresh.touch(executor);
  runtime::parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    for (int i = 0; i <= Dim; ++i)
      neighbours[e][static_cast<std::size_t>(i)] = neighbour(mesh, static_cast<ElementId>(e), i);
  });
  return neighbours;
}

/// Limits to growth hold along edges, of which a coarse mesh has few: those of the adapted mesh
/// show more. As long as they ask for much more there, the mesh is adapted to that, too.
template <int Dim>
Mesh<Dim> with_growth_limited(const runtime::Executor& executor, const AdaptOptions& options,
                              const std::string& name, std::optional<Adapter<Dim>>& adapter) {
  constexpr double much = 1.1;
  constexpr int most_times = 5;
  Mesh<Dim> mesh = adapter->take_mesh();
  if (!limits_growth(options) || !options.insert) return mesh;
  for (int time = 0; time < most_times; ++time) {
    renumber(executor, mesh);
    auto metric_of = runtime::make_vector<Metric<Dim>>(executor, mesh.vertex_slots());
    runtime::parallel_for(executor, metric_of.size(),
                          [&](std::size_t v) { metric_of[v] = mesh.site_of[v].metric; });
    const double before = complexity_of_demand(executor, mesh, metric_of);
    std::vector<std::string> told;  // by the first metrics
    limit_sizes(executor, mesh, {options, name, told}, metric_of);
    if (complexity_of_demand(executor, mesh, metric_of) < much * before) break;
    expect_possible(executor, mesh, metric_of, name, options);
    AdaptReport report = std::move(adapter->report());
    Neighbours<Dim> neighbours = neighbours_of(executor, mesh);
    adapter.emplace(executor, options, std::move(mesh), std::move(neighbours), metric_of);
    adapter->report() = std::move(report);
    adapter->adapt_anew();
    mesh = adapter->take_mesh();
  }
  return mesh;
}

template <int Dim>
Attempt adapt_once(const runtime::Executor& executor, const AnyMesh& any, const AnyField& metric,
                   const AdaptOptions& options) {
  const Stopwatch watch;
  std::vector<std::string> warnings;
  std::size_t fixed = 0;
  bool may_meet = false;
  std::optional<Adapter<Dim>> adapter;
  const auto set_up = [&] {
    adapter.reset();
    warnings.clear();
    Neighbours<Dim> neighbours;
    Mesh<Dim> mesh = make_mesh<Dim>(executor, any, options.make, neighbours, warnings);
    may_meet = mesh.surface || has_crack_sides(mesh);
    fixed = fixed_vertices(executor, mesh);
    auto metric_of = metrics_of<Dim>(executor, metric, mesh, options, warnings);
    expect_possible(executor, mesh, metric_of, metric.name, options);
    adapter.emplace(executor, options, std::move(mesh), std::move(neighbours),
                    std::exchange(metric_of, {}));
  };
  set_up();
  adapter->report().setup_seconds = watch.seconds();
  run<Dim>(adapter, set_up);
  Mesh<Dim> mesh = with_growth_limited(executor, options, metric.name, adapter);
  round_boundary(mesh);
  count_curved_edges(executor, mesh, adapter->report());
  count_held_edges(executor, mesh, options.rules, adapter->report());
  const bool has_short = has_short_facets(executor, mesh, options.rules);
  auto [adapted, metric_on_it] = take_apart(executor, std::move(mesh));
  Attempt result{
      {std::move(adapted), std::move(metric_on_it), adapter->report()}, may_meet, has_short};
  result.adapted.report.warnings = std::move(warnings);
  result.adapted.report.fixed_vertices = fixed;
  return result;
}

/// Warns where faces that are flat except for noise keep all their vertices.
template <int Dim>
void warn_of_noise(const runtime::Executor& executor, const AnyMesh& any, AdaptedMesh& adapted) {
  constexpr double margin = 2;  // since the surface that is approximated has noise, too
  // The input has more facets to judge by, unless it leaves them out.
  const AnyMesh& judged = facets_in<Dim>(any).size() > 0 ? any : adapted.mesh;
  const double noise = noise_in_flat_faces<Dim>(executor, judged);
  if (!(noise > 0)) return;
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2g", margin * noise);
  adapted.report.warnings.push_back(name_of(any) + ": boundary faces are flat up to " +
                                    text.data() + ", probably by rounding; -hausd " + text.data() +
                                    " (hausdorff_tolerance) lets them be coarsened");
}

template <int Dim>
AdaptedMesh adapt_in(const runtime::Executor& executor, const AnyMesh& any, const AnyField& metric,
                     const AdaptOptions& options) {
  const Stopwatch watch;
  Rescue<Dim> rescue(executor, any, options.make);
  AdaptOptions again = options;
  while (true) {
    auto [result, may_meet, has_short] = adapt_once<Dim>(executor, any, metric, again);
    if (has_short && !(options.make.hausdorff_tolerance > 0))
      warn_of_noise<Dim>(executor, any, result);
    if (!may_meet && rescue.attempts() == 0) {
      result.report.total_seconds = watch.seconds();
      return std::move(result);
    }
    if (rescue.accepts(result.mesh)) {
      result.report.attempts = rescue.attempts();
      result.report.checked = rescue.is_right();
      rescue.warn(result.report.warnings);
      result.report.total_seconds = watch.seconds();
      return std::move(result);
    }
    again.make = rescue.options();
  }
}

}  // namespace

AdaptedMesh adapt_mesh(const runtime::Executor& executor, const AnyMesh& mesh,
                       const AnyField& metric, const AdaptOptions& options) {
  AdaptedMesh result = mesh.dimension == 2 ? adapt_in<2>(executor, mesh, metric, options)
                                           : adapt_in<3>(executor, mesh, metric, options);
  result.report.instructions = name_of(best_instructions());
  return result;
}

}  // namespace ductile::meshadapt
