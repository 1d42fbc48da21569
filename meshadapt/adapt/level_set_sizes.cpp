#include "ductile/meshadapt/level_set_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

using Edge = std::array<VertexId, 2>;

std::vector<double> values_at(const Executor& executor, const PointFunction& function,
                              const std::vector<double>& coordinates, int dimension) {
  std::vector<double> values = function(coordinates);
  const std::size_t count = coordinates.size() / static_cast<std::size_t>(dimension);
  if (values.size() != count)
    throw InputError("level set: expected " + std::to_string(count) +
                     " values, one for each point, found " + std::to_string(values.size()));
  const std::size_t bad =
      first_bad(executor, count, [&](std::size_t i) { return !std::isfinite(values[i]); });
  if (bad == no_index) return values;
  std::string point;
  for (int axis = 0; axis < dimension; ++axis)
    point +=
        (axis == 0 ? "(" : ", ") + number(coordinates[bad * static_cast<std::size_t>(dimension) +
                                                      static_cast<std::size_t>(axis)]);
  throw InputError("level set: expected a finite value at " + point + "), found " +
                   number(values[bad]));
}

/// The sizes that edges of a mesh need for the zero of a function to be resolved.
template <int Dim>
class Resolution {
 public:
  Resolution(const Executor& executor, const AnyMesh& mesh, const PointFunction& function,
             const LevelSetSizesOptions& options)
      : executor_(executor),
        mesh_(make_fixed_mesh<Dim>(executor, mesh)),
        options_(options),
        value_of_(values_at(executor, function, mesh.coordinates, Dim)),
        steepest_of_(steepest()),
        edges_(edges_near_zero()),
        value_in_(values_at(executor, function, middles(), Dim)) {}

  /// Refines metrics at the ends of edges where the zero is not resolved. Returns how far the
  /// function is from linear, at most, on those that the metrics did not ask to be that short.
  double refine(std::vector<Metric<Dim>>& metric_of) const {
    constexpr double finer = 1.2;  // of squared lengths
    std::vector<double> size_of(metric_of.size(), std::numeric_limits<double>::infinity());
    double farthest = 0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const double size = size_for(e);
      const Vector<Dim> along = direction(edges_[e]);
      const double square = dot(along, along) / (size * size);
      for (const VertexId v : edges_[e])
        if (square > finer * squared_length(metric_of[v], along)) {
          size_of[v] = std::min(size_of[v], size);
          farthest = std::max(farthest, off_at(e));
        }
    }
    runtime::parallel_for(executor_, metric_of.size(), [&](std::size_t v) {
      if (std::isfinite(size_of[v]))
        metric_of[v] = intersect(metric_of[v], isotropic<Dim>(size_of[v]));
    });
    return farthest;
  }

 private:
  Vector<Dim> direction(const Edge& edge) const {
    return mesh_.position_of[edge[1]] - mesh_.position_of[edge[0]];
  }

  /// [vertex], the largest slope of the linear interpolant in the elements around.
  std::vector<double> steepest() const {
    std::vector<double> slope_of(mesh_.element_count()), steepest_of(mesh_.vertex_count());
    runtime::parallel_for(executor_, slope_of.size(), [&](std::size_t e) {
      const auto hat = hat_gradients<Dim>(mesh_.points(static_cast<ElementId>(e)));
      Vector<Dim> slope;
      for (std::size_t i = 0; i <= Dim; ++i) slope += value_of_[mesh_.corners_of[e][i]] * hat[i];
      slope_of[e] = norm(slope);
    });
    runtime::parallel_for(executor_, steepest_of.size(), [&](std::size_t v) {
      for (const ElementId e : mesh_.elements_of(static_cast<VertexId>(v)))
        steepest_of[v] = std::max(steepest_of[v], slope_of[e]);
    });
    return steepest_of;
  }

  /// Edges of elements in which the function may be 0: sorted, each once.
  std::vector<Edge> edges_near_zero() const {
    auto edges = runtime::parallel_collect<Edge>(
        executor_, mesh_.element_count(), [&](std::size_t e, auto&& append) {
          const Corners<Dim>& corners = mesh_.corners_of[e];
          double least = std::numeric_limits<double>::infinity(), steepest = 0, longest = 0;
          for (const VertexId v : corners) {
            least = std::min(least, std::abs(value_of_[v]));
            steepest = std::max(steepest, steepest_of_[v]);
          }
          for (std::size_t k = 0; k < Simplex<Dim>::edges; ++k)
            longest = std::max(longest, norm(direction(ends_of_edge<Dim>(corners, k))));
          for (std::size_t k = 0; k < Simplex<Dim>::edges && least <= steepest * longest; ++k) {
            const auto [a, b] = ends_of_edge<Dim>(corners, k);
            append(Edge{std::min(a, b), std::max(a, b)});
          }
        });
    runtime::parallel_sort(executor_, std::span(edges));
    edges.resize(runtime::parallel_unique(executor_, std::span(edges)));
    return {edges.begin(), edges.end()};
  }

  std::vector<double> middles() const {
    std::vector<double> coordinates(edges_.size() * Dim);
    runtime::parallel_for(executor_, edges_.size(), [&](std::size_t e) {
      const Vector<Dim> middle =
          0.5 * (mesh_.position_of[edges_[e][0]] + mesh_.position_of[edges_[e][1]]);
      std::copy_n(middle.x.begin(), Dim, &coordinates[e * Dim]);
    });
    return coordinates;
  }

  /// How far the zero may be from that of the linear interpolant, by the middle of an edge.
  double off_at(std::size_t edge) const {
    const auto [from, to] = edges_[edge];
    const double steepest = std::max(steepest_of_[from], steepest_of_[to]);
    const double linear = 0.5 * (value_of_[from] + value_of_[to]);
    return steepest > 0 ? std::abs(value_in_[edge] - linear) / steepest : 0;
  }

  /// Infinite where the edge may be as long as it is: where the function is linear within the
  /// tolerance, and where its halves would be below the smallest size, as in the end at kinks and
  /// other singular points. Otherwise an edge between ends of different signs is divided by how far
  /// the function is from linear. One between ends of the same sign is halved if the function has
  /// the other sign in the middle, or has a kink and, falling as steeply as around there, could
  /// have it in one of the halves.
  double size_for(std::size_t edge) const {
    constexpr double kink = 0.1;  // a bend of the function that is sharper, over the length
    constexpr double half = 0.4;  // because edges may become longer than the metric asks for
    const double infinite = std::numeric_limits<double>::infinity();
    const double least = options_.smallest_size > 0 ? options_.smallest_size : options_.tolerance;
    const auto [from, to] = edges_[edge];
    const double a = value_of_[from], b = value_of_[to], middle = value_in_[edge];
    const double steepest = std::max(steepest_of_[from], steepest_of_[to]);
    const double length = norm(direction(edges_[edge]));
    const double off = off_at(edge);
    if (off <= options_.tolerance || length < 2 * least) return infinite;
    double share = half;
    if ((a < 0) != (b < 0)) {
      share = std::max(half, 2 * half * std::sqrt(options_.tolerance / off));
    } else if ((middle < 0) == (a < 0)) {
      const double nearer = std::min(std::abs(a), std::abs(b));
      if (off <= kink * length || nearer + std::abs(middle) > 0.5 * steepest * length)
        return infinite;
    }
    return std::max(least, share * length);
  }

  const Executor& executor_;
  FixedMesh<Dim> mesh_;
  const LevelSetSizesOptions& options_;
  std::vector<double> value_of_;     // [vertex]
  std::vector<double> steepest_of_;  // [vertex]
  std::vector<Edge> edges_;
  std::vector<double> value_in_;  // [edge], in the middle
};

/// Makes a metric finer where the zero is not resolved; see Resolution::refine().
struct Wanted {
  const PointFunction& function;
  const LevelSetSizesOptions& options;

  double refine(const Executor& executor, const AnyMesh& mesh, AnyField& metric) const {
    return mesh.dimension == 2 ? refine_in<2>(executor, mesh, metric)
                               : refine_in<3>(executor, mesh, metric);
  }

 private:
  template <int Dim>
  double refine_in(const Executor& executor, const AnyMesh& mesh, AnyField& metric) const {
    auto metric_of = tensors_of<Dim>(executor, metric);
    const double off = Resolution<Dim>(executor, mesh, function, options).refine(metric_of);
    if (off > 0) metric = symmetric_field(executor, metric_of, metric.name);
    return off;
  }
};

/// A metric that is fine enough for the input, made finer on each adapted mesh.
class LevelSetSizes : public MetricSource {
 public:
  LevelSetSizes(const AnyField& first, const Wanted& wanted) : first_(first), wanted_(wanted) {}

  const AnyField* next(const AdaptState& state) override {
    if (state.pass == 0) return &first_;
    metric_ = state.adapted().metric;
    off_ = wanted_.refine(state.executor, state.mesh(), metric_);
    return off_ == 0 || state.pass >= wanted_.options.most_passes ? nullptr : &metric_;
  }

  /// See Resolution::refine(), after the last pass.
  double off() const { return off_; }

 private:
  const AnyField& first_;
  const Wanted& wanted_;
  AnyField metric_;
  double off_ = 0;
};

void expect_sizes(const PointFunction& function, const LevelSetSizesOptions& sizes) {
  if (!function) throw InputError("level set: expected a function, found none");
  if (!(sizes.tolerance >= smallest_size && sizes.tolerance <= largest_size))
    throw InputError("level set: expected a tolerance from 1e-75 to 1e75, found " +
                     number(sizes.tolerance));
  if (!(sizes.smallest_size >= 0 && sizes.smallest_size <= largest_size))
    throw InputError("level set: expected a smallest size from 0 to 1e75, found " +
                     number(sizes.smallest_size));
}

}  // namespace

AdaptedMesh refine_to_level_set(const Executor& executor, const AnyMesh& mesh,
                                const AnyField& metric, const PointFunction& function,
                                const LevelSetSizesOptions& options) {
  expect_sizes(function, options);
  AnyField finer =
      metric_of(metric, mesh, {options.adapt.smallest_size, options.adapt.largest_size});
  const Wanted wanted{function, options};
  constexpr double far = 2;  // tolerances; each pass makes a few edges that are a little too long
  if (wanted.refine(executor, mesh, finer) == 0) return {mesh, finer, {}};
  LevelSetSizes source(finer, wanted);
  AdaptedMesh adapted = adapt(executor, mesh, source, options.adapt);
  if (source.off() > far * options.tolerance)
    adapted.report.warnings.push_back(name_of(mesh) + ": the level set is not resolved after " +
                                      std::to_string(options.most_passes) + " passes, but off by " +
                                      number(source.off()) + "; allow more, or a larger tolerance");
  return adapted;
}

}  // namespace ductile::meshadapt
