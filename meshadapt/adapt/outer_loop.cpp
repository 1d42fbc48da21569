#include "adapt/outer_loop.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapt/adapter.hpp"
#include "adapt/edge_counts.hpp"
#include "adapt/rescue.hpp"
#include "adapt/size_limits.hpp"
#include "adapt/take_apart.hpp"
#include "core/instructions.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/rounding.hpp"
#include "geometry/surface_mesh.hpp"
#include "mesh/wording.hpp"
#include "operators/round_boundary.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

template <int Dim, int Space>
std::size_t fixed_vertices(const Executor& executor, const Mesh<Dim, Space>& mesh) {
  const auto is_fixed = [&](std::size_t v) {
    return std::size_t{mesh.kind_of[v].class_dimension == 0 &&
                       mesh.vertex_alive(static_cast<VertexId>(v))};
  };
  return runtime::parallel_reduce(executor, mesh.vertex_slots(), std::size_t{0}, is_fixed,
                                  std::plus<>());
}

template <int Dim, int Space>
bool has_crack_sides(const Mesh<Dim, Space>& mesh) {
  return std::any_of(mesh.patches.begin(), mesh.patches.end(),
                     [](const auto& patch) { return patch.crack_side; });
}

template <int Dim, int Space>
Neighbours<Dim> neighbours_of(const Executor& executor, const Mesh<Dim, Space>& mesh) {
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

/// Says that faces that are flat except for this noise keep all their vertices.
std::string warning_of_noise(const std::string& mesh, double noise) {
  constexpr double margin = 2;  // because the surface that is approximated has noise, too
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2g", margin * noise);
  return mesh + ": boundary faces are flat up to " + text.data() +
         ", probably by rounding; -hausd " + text.data() +
         " (hausdorff_tolerance) lets them be coarsened";
}

/// The input, set up to be adapted to one metric after another. An attempt whose result is not
/// accepted is taken back: the input is set up again, for less effort or to keep more of its
/// boundary.
template <int Dim, int Space>
class Attempt {
 public:
  /// Refers to the executor and the input.
  Attempt(const Executor& executor, const AnyMesh& input, const AdaptOptions& options)
      : executor_(executor),
        input_(input),
        is_flat_(options.make.hausdorff_tolerance == 0),
        options_(options) {}

  /// The mesh as it stands and the metrics for the next pass, within the limits of the options.
  /// They come from the source, unless the last ones grow too fast on this mesh. Nothing if the
  /// mesh is final.
  std::optional<Start<Dim, Space>> next(MetricSource& source) {
    if (pass_ > 0) {
      if (auto start = with_growth_limited()) return start;
      if (auto start = farther()) return start;
    }
    growths_ = 0;
    share_long_ = 1;
    const AnyField* metric = source.next(
        {executor_, pass_, input_, [this]() -> const MeshWithMetric& { return copy(); }});
    if (metric == nullptr && pass_ == 0)
      throw InputError(name_of(input_) + ": expected a metric to adapt it to, found none");
    if (metric == nullptr) return std::nullopt;
    if (pass_ < most_passes) return with_limits(*metric);
    warn(name_of(*metric) + ": the mesh was adapted " + std::to_string(pass_) +
         " times, and metrics still come; they are left out");
    return std::nullopt;
  }

  /// Adapts; ends with keep() or take_back(). Refers to this.
  Adapter<Dim, Space> adapter(Start<Dim, Space> start) {
    const runtime::PhaseTimer timer(report_.setup_seconds);
    copy_.reset();
    return Adapter<Dim, Space>(executor_, options_, std::move(start), report_);
  }
  Effort effort() const { return pass_ == 0 ? effort_ : Effort::everything; }

  void keep(Adapter<Dim, Space>& adapter) {
    mesh_ = adapter.take_mesh();
    ++pass_;
  }

  void take_back(Effort effort) { take_back(effort, options_.make); }
  void take_back(Effort effort, MakeMeshOptions make) {
    effort_ = effort;
    share_long_ = 1;
    options_.make = std::move(make);
    report_ = {};
    pass_ = 0;
  }

  AdaptedMesh result() {
    copy_.reset();
    round_boundary(mesh_);
    count_edges(executor_, mesh_, options_.rules, report_);
    const bool has_short = has_short_facets(executor_, mesh_, options_.rules);
    auto [mesh, metric] = take_apart(executor_, std::move(mesh_));
    if (has_short && is_flat_ && noise_ > 0)
      report_.warnings.push_back(warning_of_noise(name_of(input_), noise_));
    return {std::move(mesh), std::move(metric), std::move(report_)};
  }

  /// May the boundary have met itself?
  bool may_meet() const { return may_meet_; }

 private:
  void warn(const std::string& warning) {
    auto& all = report_.warnings;
    if (std::find(all.begin(), all.end(), warning) == all.end()) all.push_back(warning);
  }

  /// The mesh as a file would hold it, with the same numbers.
  const MeshWithMetric& copy() {
    if (!copy_) {
      copy_ = copy_in_order(executor_, mesh_);
      copy_->mesh.name = input_.name;
      copy_->mesh.names = input_.names;
    }
    return *copy_;
  }

  Start<Dim, Space> with_limits(const AnyField& metric) {
    const runtime::PhaseTimer timer(report_.setup_seconds);
    name_ = metric.name;
    auto metric_of = valid_metrics<Space>(executor_, pass_ == 0 ? input_ : copy().mesh, metric,
                                          {options_.smallest_size, options_.largest_size});
    Neighbours<Dim> neighbours = pass_ == 0 ? set_up() : neighbours_of(executor_, mesh_);
    for (const std::string& left : limit_sizes(executor_, mesh_, options_, metric_of))
      warn(name_ + ": " + left);
    expect_possible(executor_, mesh_, options_, metric_of, name_);
    return {std::move(mesh_), std::move(neighbours), std::move(metric_of)};
  }

  /// Makes the mesh from the input.
  Neighbours<Dim> set_up() {
    Neighbours<Dim> neighbours;
    mesh_ = {};  // before there is another
    if constexpr (Dim < Space)
      mesh_ = make_surface_mesh(executor_, input_, options_.make, neighbours, report_.warnings);
    else
      mesh_ = make_mesh<Dim>(executor_, input_, options_.make, neighbours, report_.warnings);
    may_meet_ = Dim < Space || mesh_.surface || has_crack_sides(mesh_);
    noise_ = mesh_.rounding ? mesh_.rounding->noise : 0;
    report_.fixed_vertices = fixed_vertices(executor_, mesh_);
    return neighbours;
  }

  /// A metric whose sizes differ extremely may not be reached at once: the next pass starts from
  /// the adapted mesh, as long as many edges are too long and each pass leaves clearly fewer.
  std::optional<Start<Dim, Space>> farther() {
    constexpr double many = 0.25, fewer = 0.9;
    if (!options_.insert || options_.approach_only ||
        options_.iterations < AdaptOptions{}.iterations)
      return std::nullopt;
    const double share = share_of_long_edges(executor_, mesh_, options_.rules.long_edge);
    if (share < many || share > fewer * std::exchange(share_long_, share)) return std::nullopt;
    renumber(executor_, mesh_);
    return from_here(metrics_here());
  }

  std::vector<Metric<Space>> metrics_here() const {
    auto metric_of = runtime::make_vector<Metric<Space>>(executor_, mesh_.vertex_slots());
    runtime::parallel_for(executor_, metric_of.size(),
                          [&](std::size_t v) { metric_of[v] = mesh_.site_of[v].metric; });
    return metric_of;
  }

  Start<Dim, Space> from_here(std::vector<Metric<Space>> metric_of) {
    expect_possible(executor_, mesh_, options_, metric_of, name_);
    Neighbours<Dim> neighbours = neighbours_of(executor_, mesh_);
    return {std::move(mesh_), std::move(neighbours), std::move(metric_of)};
  }

  /// Growth is limited along edges, of which a coarse mesh has few. Limits the metrics of the
  /// adapted mesh along its edges; nothing if that asks for hardly more elements.
  std::optional<Start<Dim, Space>> with_growth_limited() {
    constexpr double much = 1.1;
    constexpr int most_times = 5;
    if (!limits_growth(options_) || !options_.insert || growths_ == most_times) return std::nullopt;
    ++growths_;
    renumber(executor_, mesh_);
    auto metric_of = metrics_here();
    const double before = complexity_of_demand(executor_, mesh_, metric_of);
    // A geometry may have features between the vertices that were asked.
    if (options_.make.geometry)
      limit_sizes(executor_, mesh_, options_, metric_of);
    else
      limit_growth(executor_, mesh_, options_, metric_of);
    if (complexity_of_demand(executor_, mesh_, metric_of) < much * before) return std::nullopt;
    return from_here(std::move(metric_of));
  }

  const Executor& executor_;
  const AnyMesh& input_;
  bool is_flat_;  ///< asked for without a Hausdorff tolerance
  AdaptOptions options_;
  Effort effort_ = Effort::as_needed;  ///< for the input
  int pass_ = 0;
  int growths_ = 0;                     ///< times in a row that growth was limited
  double share_long_ = 1;               ///< of the edges, before the last pass of farther()
  Mesh<Dim, Space> mesh_;               ///< as it stands between passes
  std::string name_;                    ///< of the metric
  std::optional<MeshWithMetric> copy_;  ///< of the mesh
  AdaptReport report_;
  bool may_meet_ = false;
  double noise_ = 0;  ///< in flat faces
};

}  // namespace

template <int Dim, int Space>
AdaptedMesh adapt_in(const Executor& executor, const AnyMesh& input, MetricSource& source,
                     const AdaptOptions& options) {
  double seconds = 0;
  AdaptedMesh adapted;
  {
    const runtime::PhaseTimer timer(seconds);
    Rescue<Space> rescue(executor, input, options.make);
    Attempt<Dim, Space> attempt(executor, input, options);
    while (true) {
      if (auto start = attempt.next(source)) {
        Adapter<Dim, Space> adapter = attempt.adapter(std::move(*start));
        if (const auto less = adapter.run(attempt.effort()))
          attempt.take_back(*less);
        else
          attempt.keep(adapter);
        continue;
      }
      adapted = attempt.result();
      if (rescue.accepts(adapted, attempt.may_meet())) break;
      attempt.take_back(Effort::as_needed, rescue.options());
    }
  }
  adapted.report.total_seconds = seconds;
  adapted.report.instructions = name_of(best_instructions());
  return adapted;
}

template AdaptedMesh adapt_in<2>(const Executor&, const AnyMesh&, MetricSource&,
                                 const AdaptOptions&);
template AdaptedMesh adapt_in<2, 3>(const Executor&, const AnyMesh&, MetricSource&,
                                    const AdaptOptions&);
template AdaptedMesh adapt_in<3>(const Executor&, const AnyMesh&, MetricSource&,
                                 const AdaptOptions&);

}  // namespace ductile::meshadapt
