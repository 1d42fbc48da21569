#include "ductile/meshadapt/level_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "levelset/crossings.hpp"
#include "levelset/cut_writer.hpp"
#include "levelset/sides.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// Values and their differences stay finite.
constexpr double largest_value = 1e150;

void expect_options(const CutOptions& options) {
  if (!(std::abs(options.level) <= largest_value))
    throw InputError("level: expected a number from -1e150 to 1e150, found " +
                     number(options.level));
  if (!(options.least_component >= 0 && options.least_component < 1))
    throw InputError(
        "least_component: expected a fraction of the volume, from 0 to below 1, found " +
        number(options.least_component));
}

void expect_cut_values(const Executor& executor, const AnyMesh& mesh,
                       std::span<const double> values) {
  if (values.size() != mesh.vertex_count())
    throw InputError("values: expected one for each of the " + std::to_string(mesh.vertex_count()) +
                     " vertices, found " + std::to_string(values.size()));
  const std::size_t bad = first_bad(executor, values.size(), [&](std::size_t v) {
    return !(std::abs(values[v]) <= largest_value);
  });
  if (bad != no_index)
    refuse("expected a number from -1e150 to 1e150, found " + number(values[bad]) + " at " +
           entry("values", "vertex", bad));
}

template <int Dim>
class Cutter {
 public:
  Cutter(const Executor& executor, const AnyMesh& mesh, std::span<const double> values,
         const CutOptions& options)
      : executor_(executor),
        values_(values),
        options_(options),
        domain_(make_cut_domain<Dim>(executor, mesh, options)),
        position_of_(domain_.mesh.position_of),
        whole_volume_(
            std::accumulate(domain_.mesh.volume_of.begin(), domain_.mesh.volume_of.end(), 0.0)) {}

  CutMesh run() {
    if (!options_.keep_volume) return at_level(options_.level);
    return at_volume(*options_.keep_volume);
  }

 private:
  CutMesh at_level(double level) {
    domain_.mesh.position_of = position_of_;
    std::vector<double> function(values_.size());
    parallel_for(executor_, function.size(),
                 [&](std::size_t v) { function[v] = values_[v] - level; });
    std::vector<double> value_of = function;  // without zeros and small parts
    const auto removed =
        choose_sides(executor_, domain_, value_of, options_.least_component * whole_volume_);
    Snapped snapped{std::vector<std::int8_t>(value_of.size()),
                    std::vector<VertexOrigin>(value_of.size()),
                    find_crossings<Dim>(executor_, domain_, value_of)};
    parallel_for(executor_, value_of.size(), [&](std::size_t v) {
      const auto vertex = static_cast<VertexId>(v);
      snapped.sign_of[v] = value_of[v] < 0 ? -1 : 1;
      snapped.origin_of[v] = {vertex, vertex, 0};
    });
    if (options_.curved) bend_crossings<Dim>(executor_, domain_, function, snapped.crossings);
    const bool is_met = !snapped.crossings.empty();
    Snapping<Dim>(executor_, domain_, snapped).run();
    CutMesh made = CutWriter<Dim>(executor_, domain_, snapped).write(options_.interface);
    made.value.resize(made.mesh.vertex_count());
    parallel_for(executor_, value_of.size(),
                 [&](std::size_t v) { made.value[v] = snapped.sign_of[v] == 0 ? 0 : value_of[v]; });
    made.report.level = level;
    made.report.removed_components = removed.count;
    made.report.removed_volume = removed.volume;
    if (!is_met) made.report.warnings.push_back(never_met(level, removed.count));
    return made;
  }

  std::string never_met(double level, std::size_t removed) const {
    const auto [least, most] = std::minmax_element(values_.begin(), values_.end());
    return name_of(domain_.any) + ": the level " + number(level) + " is met nowhere" +
           (removed != 0 ? " after small components have been removed" : "") +
           ", values are from " + number(*least) + " to " + number(*most) +
           "; all elements are on one side";
  }

  // ---- To a volume ----

  /// Cuts at the level where the linear interpolant has the volume, and again at one where it has
  /// as much more as the cut mesh had less.
  CutMesh at_volume(double wanted) {
    constexpr int most_cuts = 4;
    constexpr double close = 1e-6;  // of the volume
    const double all =
        volume_below(executor_, domain_, values_, std::numeric_limits<double>::infinity());
    if (!(wanted > 0 && wanted < all))
      throw InputError("keep_volume: expected one between 0 and that of the elements to split, " +
                       number(all) + ", found " + number(wanted));
    double aim = wanted;
    CutMesh best;
    double best_error = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_cuts && best_error > close * wanted; ++i) {
      CutMesh made = at_level(level_of_volume(aim));
      const double error = wanted - made.report.minus_volume;
      aim = std::clamp(aim + error, 1e-6 * all, (1 - 1e-6) * all);
      if (!(std::abs(error) < best_error)) continue;
      best_error = std::abs(error);
      best = std::move(made);
    }
    return best;
  }

  double level_of_volume(double volume) const {
    constexpr int steps = 60;
    const auto [least, most] = std::minmax_element(values_.begin(), values_.end());
    double low = *least, high = *most;
    for (int i = 0; i < steps; ++i) {
      const double middle = low + (high - low) / 2;
      (volume_below(executor_, domain_, values_, middle) < volume ? low : high) = middle;
    }
    return low + (high - low) / 2;
  }

  const Executor& executor_;
  std::span<const double> values_;
  const CutOptions& options_;
  CutDomain<Dim> domain_;
  std::vector<Vector<Dim>> position_of_;  // [vertex], before vertices are moved
  double whole_volume_;
};

/// Throws unless the field has a value for each vertex of the mesh before.
void expect_field_before(const AnyField& field, const CutMesh& cut) {
  expect_values(field);
  std::size_t before = 0;
  while (before < cut.vertex_origin.size() && cut.vertex_origin[before].a == before) ++before;
  if (field.dimension != cut.mesh.dimension || field.vertex_count != before)
    throw InputError(name_of(field) + ": expected a field of dimension " +
                     std::to_string(cut.mesh.dimension) + " with " + std::to_string(before) +
                     " vertices, as the mesh before the cut, found dimension " +
                     std::to_string(field.dimension) + " and " +
                     std::to_string(field.vertex_count) + " vertices");
}

template <int Dim>
AnyField carried_metric(const Executor& executor, const AnyField& metric, const CutMesh& cut) {
  const auto tensor_of = tensors_of<Dim>(executor, metric);
  std::vector<Metric<Dim>> result(cut.vertex_origin.size());
  parallel_for(executor, result.size(), [&](std::size_t v) {
    const auto& [a, b, t] = cut.vertex_origin[v];
    result[v] = a == b
                    ? tensor_of[a]
                    : exponential((1 - t) * logarithm(tensor_of[a]) + t * logarithm(tensor_of[b]));
  });
  return symmetric_field(executor, result, metric.name);
}

}  // namespace

CutMesh cut(const Executor& executor, const AnyMesh& mesh, std::span<const double> values,
            const CutOptions& options) {
  expect_options(options);
  expect_coordinates(mesh);
  expect_cut_values(executor, mesh, values);
  return runtime::with_team(executor, [&] {
    return mesh.dimension == 2 ? Cutter<2>(executor, mesh, values, options).run()
                               : Cutter<3>(executor, mesh, values, options).run();
  });
}

AnyField field_at_cut(const Executor& executor, const AnyField& field, const CutMesh& cut) {
  expect_field_before(field, cut);
  const std::size_t stride = stride_of(field);
  AnyField result{field.dimension, cut.vertex_origin.size(), field.types, {}, field.name};
  result.values.resize(stride * result.vertex_count);
  parallel_for(executor, result.vertex_count, [&](std::size_t v) {
    const auto& [a, b, t] = cut.vertex_origin[v];
    for (std::size_t k = 0; k < stride; ++k) {
      const double from = field.values[a * stride + k], to = field.values[b * stride + k];
      result.values[v * stride + k] = a == b ? from : (1 - t) * from + t * to;
    }
  });
  return result;
}

AnyField metric_at_cut(const Executor& executor, const AnyField& metric, const CutMesh& cut) {
  expect_field_before(metric, cut);
  return metric.dimension == 2 ? carried_metric<2>(executor, metric, cut)
                               : carried_metric<3>(executor, metric, cut);
}

}  // namespace ductile::meshadapt
