#include "ductile/meshadapt/level_set.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
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
#include "mesh/scale.hpp"
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
  if (options.boundary_only && options.keep_volume)
    throw InputError("keep_volume: expected none where only the boundary is cut");
}

void expect_cut_values(const Executor& executor, const AnyMesh& mesh,
                       std::span<const double> values) {
  expect_at_each_vertex("values: expected one", mesh.vertex_count(), values.size());
  const std::size_t bad = first_bad(executor, values.size(), [&](std::size_t v) {
    return !(std::abs(values[v]) <= largest_value);
  });
  if (bad != no_index)
    refuse("expected a number from -1e150 to 1e150, found " + number(values[bad]) + " at " +
           entry("values", "vertex", bad));
}

/// Cuts a mesh, or a surface alone, which has Dim 2 and Space 3.
template <int Dim, int Space = Dim>
class Cutter {
 public:
  /// `whole`: has the tetrahedra of which the mesh is the listed facets, if it is not the mesh.
  Cutter(const Executor& executor, const AnyMesh& mesh, const AnyMesh& whole,
         std::span<const double> values, const CutOptions& options)
      : executor_(executor),
        whole_(whole),
        values_(values),
        options_(options),
        domain_(make_cut_domain<Dim, Space>(executor, mesh, options)),
        whole_volume_(
            std::accumulate(domain_.mesh.volume_of.begin(), domain_.mesh.volume_of.end(), 0.0)) {}

  CutMesh run() {
    if (!options_.keep_volume) return at_level(options_.level);
    return at_volume(*options_.keep_volume);
  }

 private:
  CutMesh at_level(double level) const {
    std::vector<double> function(values_.size());
    parallel_for(executor_, function.size(),
                 [&](std::size_t v) { function[v] = values_[v] - level; });
    std::vector<double> value_of = function;  // without zeros and small parts
    const auto removed =
        choose_sides(executor_, domain_, value_of, options_.least_component * whole_volume_);
    Snapped<Space> snapped = unsnapped(value_of);
    if constexpr (Space == Dim)
      if (options_.curved) bend_crossings<Dim>(executor_, domain_, function, snapped.crossings);
    const bool is_met = !snapped.crossings.empty();
    Snapping<Dim, Space>(executor_, domain_, snapped).run();
    CutMesh made = written(snapped);
    made.value.resize(made.mesh.vertex_count());
    parallel_for(executor_, value_of.size(),
                 [&](std::size_t v) { made.value[v] = snapped.sign_of[v] == 0 ? 0 : value_of[v]; });
    made.report.level = level;
    made.report.on_surface = Dim < Space;
    made.report.minus_volume = minus_volume(made);
    made.report.removed_components = removed.count;
    made.report.removed_volume = removed.volume;
    if (!is_met) made.report.warnings.push_back(never_met(level, removed.count));
    return made;
  }

  Snapped<Space> unsnapped(const std::vector<double>& value_of) const {
    const std::size_t count = value_of.size();
    Snapped<Space> snapped;
    snapped.place_of.resize(count);
    snapped.sign_of.resize(count);
    snapped.origin_of.resize(count);
    parallel_for(executor_, count, [&](std::size_t v) {
      const auto vertex = static_cast<VertexId>(v);
      snapped.place_of[v] = position_in<Space>(domain_.any, v);
      snapped.sign_of[v] = value_of[v] < 0 ? -1 : 1;
      snapped.origin_of[v] = {vertex, vertex, 0};
    });
    snapped.crossings = find_crossings<Dim>(executor_, domain_, value_of, snapped.place_of);
    return snapped;
  }

  CutMesh written(const Snapped<Space>& snapped) const {
    CutWriter<Dim, Space> writer(executor_, domain_, snapped);
    if constexpr (Dim < Space)
      if (whole_.tetrahedra.size() > 0)
        return writer.write_with_tetrahedra(whole_, options_.interface);
    return writer.write(options_.interface);
  }

  double minus_volume(const CutMesh& made) const {
    const auto& corners_of = elements_in<Dim>(made.mesh).vertices;
    const auto& origin_of = options_.boundary_only ? made.facet_origin : made.element_origin;
    return runtime::parallel_reduce(
        executor_, corners_of.size(), 0.0,
        [&](std::size_t e) {
          if (!domain_.is_split(origin_of[e]) ||
              !std::ranges::any_of(corners_of[e], [&](VertexId v) { return made.value[v] < 0; }))
            return 0.0;
          return volume_of_simplex<Dim, Space>(points_in<Space>(made.mesh, corners_of[e]));
        },
        std::plus<>());
  }

  std::string never_met(double level, std::size_t removed) const {
    const auto [least, most] = std::minmax_element(values_.begin(), values_.end());
    return name_of(domain_.any) + ": the level " + number(level) + " is met nowhere" +
           (removed != 0 ? " after small components have been removed" : "") +
           ", values are from " + number(*least) + " to " + number(*most) +
           "; all elements are on one side";
  }

  // ---- To a volume ----

  static constexpr double close = 1e-6;  // of the volume

  /// Cuts at the level where the linear interpolant has the volume, and again at one where it has
  /// as much more as the cut mesh had less; each cut may snap other vertices, so that its volume
  /// jumps. The best of these cuts is then moved to the volume.
  CutMesh at_volume(double wanted) const {
    constexpr int most_cuts = 4;
    constexpr double near = 1e-3;  // of the volume
    const double all =
        volume_below(executor_, domain_, values_, std::numeric_limits<double>::infinity());
    if (!(wanted > 0 && wanted < all))
      throw InputError("keep_volume: expected one between 0 and that of the elements to split, " +
                       number(all) + ", found " + number(wanted));
    double aim = wanted, best_error = std::numeric_limits<double>::infinity();
    CutMesh best;
    for (int i = 0; i < most_cuts && best_error > near * wanted; ++i) {
      CutMesh made = at_level(level_of_volume(aim));
      const double error = wanted - made.report.minus_volume;
      aim = std::clamp(aim + error, 1e-6 * all, (1 - 1e-6) * all);
      if (!(std::abs(error) < best_error)) continue;
      best_error = std::abs(error);
      best = std::move(made);
    }
    move_to_volume(best, wanted);
    if (std::abs(best.report.minus_volume - wanted) > close * wanted)
      best.report.warnings.push_back(
          name_of(domain_.any) + ": the part below has the volume " +
          number(best.report.minus_volume) + ", not " + number(wanted) +
          ": no level gives that with this topology; refine the mesh, or change keep_volume");
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

  /// Changes the level of a cut by a little, with the same vertices on the surface: they move along
  /// the edges that they come from, until the volume is within `close` of the wanted one. The level
  /// passes no value of another vertex, so the topology stays that of the interpolant.
  void move_to_volume(CutMesh& made, double wanted) const {
    constexpr int most_steps = 60;
    const CutMesh before = made;
    const auto [least, most] = std::minmax_element(values_.begin(), values_.end());
    double low = *least - *most, high = -low;
    for (const double value : made.value) {
      if (value < 0) low = std::max(low, 0.9 * value);
      if (value > 0) high = std::min(high, 0.9 * value);
    }
    double low_error = shift(made, before, low) - wanted;
    double high_error = shift(made, before, high) - wanted;
    double error = before.report.minus_volume - wanted, by = 0;
    for (int i = 0; std::abs(error) > close * wanted; ++i) {
      if (!(low_error < 0 && high_error > 0) || i == most_steps) break;
      (error < 0 ? low : high) = by;
      (error < 0 ? low_error : high_error) = error;
      // Every third step halves, because one end may stay where it is.
      by = low + (i % 3 == 2 ? 0.5 : low_error / (low_error - high_error)) * (high - low);
      error = shift(made, before, by) - wanted;
    }
    if (!(std::abs(error) < std::abs(before.report.minus_volume - wanted)) || !is_valid(made))
      made = before;
    else
      finish_shift(made, by);
  }

  /// Places the vertices on the surface where the function is by this much more than at the cut
  /// before. Returns the volume below.
  double shift(CutMesh& made, const CutMesh& before, double by) const {
    constexpr double least_part = 0.04;
    const double level = before.report.level;
    parallel_for(executor_, made.vertex_origin.size(), [&](std::size_t v) {
      const auto& [a, b, t] = before.vertex_origin[v];
      const double from = values_[a] - level, to = values_[b] - level;
      if (a == b || !(from * to < 0)) return;
      const double moved =
          std::clamp(t + by / (to - from), std::min(t, least_part), std::max(t, 1 - least_part));
      const auto end = position_in<Space>(domain_.any, a),
                 along = position_in<Space>(domain_.any, b) - end;
      const Vector<Space> place = end + moved * along;
      std::copy_n(place.x.begin(), Space, &made.mesh.coordinates[Space * v]);
      made.vertex_origin[v].t = moved;
    });
    return minus_volume(made);
  }

  bool is_valid(const CutMesh& made) const {
    if constexpr (Space == Dim) {
      const auto& corners_of = elements_in<Dim>(made.mesh).vertices;
      return first_bad(executor_, corners_of.size(), [&](std::size_t e) {
               return orientation<Dim>(points_in<Dim>(made.mesh, corners_of[e])) <= 0;
             }) == no_index;
    }
    return true;
  }

  void finish_shift(CutMesh& made, double by) const {
    made.report.level += by;
    made.report.minus_volume = minus_volume(made);
    for (double& value : made.value)
      if (value != 0) value -= by;
  }

  const Executor& executor_;
  const AnyMesh& whole_;
  std::span<const double> values_;
  const CutOptions& options_;
  CutDomain<Dim> domain_;
  double whole_volume_;
};

/// The listed facets of tetrahedra, as a surface alone.
AnyMesh boundary_of(const AnyMesh& mesh) {
  if (mesh.tetrahedra.size() == 0 || mesh.triangles.size() == 0)
    throw InputError(name_of(mesh) +
                     ": expected tetrahedra and triangles, which alone are to be cut, found " +
                     (mesh.tetrahedra.size() == 0 ? "no tetrahedra" : "no triangles"));
  AnyMesh boundary = mesh;
  boundary.tetrahedra = {};
  boundary.required_tetrahedra.clear();
  return boundary;
}

CutMesh cut_any(const Executor& executor, const AnyMesh& mesh, std::span<const double> values,
                const CutOptions& options) {
  if (options.boundary_only) {
    const AnyMesh boundary = boundary_of(mesh);
    return Cutter<2, 3>(executor, boundary, mesh, values, options).run();
  }
  if (is_surface(mesh)) return Cutter<2, 3>(executor, mesh, mesh, values, options).run();
  return mesh.dimension == 2 ? Cutter<2>(executor, mesh, mesh, values, options).run()
                             : Cutter<3>(executor, mesh, mesh, values, options).run();
}

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
  return runtime::with_team(executor, [&] { return cut_any(executor, mesh, values, options); });
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
