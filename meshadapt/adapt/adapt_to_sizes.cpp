#include "ductile/meshadapt/adapt.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adapt/sizes_again.hpp"
#include "core/first_bad.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "metric/entities_of.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

constexpr double near_enough = 1.5;  // times the size asked for

template <int Dim>
bool has_sizes_in(const Executor& executor, const AnyField& metric,
                  const std::vector<double>& size_of, double smallest) {
  const auto metric_of = tensors_of<Dim>(executor, metric);
  return first_bad(executor, metric_of.size(), [&](std::size_t v) {
           const auto& value = principal_axes(metric_of[v]).value;
           const double size = 1 / std::sqrt(*std::max_element(value.begin(), value.end()));
           return !(size < near_enough * std::max(size_of[v], smallest));
         }) == no_index;
}

/// The entities of a list as points and segments, which are flat triangles.
TriangleSurface places_of(const AnyMesh& mesh, const EntityList& list) {
  TriangleSurface surface;
  const auto add = [&](std::uint32_t vertex) {
    Vector<3> point;
    for (int axis = 0; axis < mesh.dimension; ++axis)
      point[axis] = mesh.coordinates[static_cast<std::size_t>(mesh.dimension) * vertex +
                                     static_cast<std::size_t>(axis)];
    surface.points.push_back(point);
    return static_cast<std::uint32_t>(surface.points.size() - 1);
  };
  for (const auto& corners : list.corners) {
    const std::uint32_t a = add(corners[0]), b = list.dimension > 0 ? add(corners[1]) : a;
    surface.triangles.push_back({a, b, b});
  }
  return surface;
}

}  // namespace

bool has_sizes(const Executor& executor, const AnyField& metric, const std::vector<double>& size_of,
               double smallest) {
  return metric.dimension == 2 ? has_sizes_in<2>(executor, metric, size_of, smallest)
                               : has_sizes_in<3>(executor, metric, size_of, smallest);
}

Sizes lasting(const AnyMesh& mesh, const Sizes& sizes) {
  Sizes result{.elsewhere = sizes.elsewhere, .bounds = sizes.bounds};
  for (const SizeSource& source : sizes.sources) {
    std::set<std::pair<int, std::int32_t>> references;
    if (const auto* entities = std::get_if<Referenced>(&source.place))
      references = {{entities->dimension, entities->reference}};
    if (const auto* named = std::get_if<Named>(&source.place))
      references = references_named(mesh, named->name);
    if (references.empty()) result.sources.push_back(source);
    for (const auto& [dimension, reference] : references) {
      SizeSource part = source;
      part.place = Referenced{dimension, reference};
      if (dimension < mesh.dimension - 1)
        part.place = places_of(mesh, entities_of(mesh, dimension, reference));
      result.sources.push_back(std::move(part));
    }
  }
  return result;
}

namespace {

/// Options for what was adapted already: distances are measured from the first mesh.
MakeMeshOptions with_geometry_of(const Executor& executor, const AnyMesh& mesh,
                                 MakeMeshOptions options) {
  options.keep_facets_at.clear();  // of vertices of the first mesh
  if (options.hausdorff_tolerance > 0 && !options.geometry)
    options.geometry = std::make_shared<const Geometry>(
        executor, mesh,
        GeometryOptions{.tolerance = options.hausdorff_tolerance,
                        .ridge_angle = options.ridge_angle,
                        .complete_boundary = options.complete_boundary,
                        .functions = std::exchange(options.functions, {})});
  return options;
}

void add_report_of(const AdaptReport& before, AdaptReport& report) {
  report.total_seconds += before.total_seconds;
  std::vector<std::string> warnings = before.warnings;
  for (std::string& warning : report.warnings)
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
      warnings.push_back(std::move(warning));
  report.warnings = std::move(warnings);
}

}  // namespace

AdaptedMesh adapt_to_sizes(const Executor& executor, const AnyMesh& mesh, const Sizes& sizes,
                           const AdaptOptions& options) {
  const SizeBounds bounds{options.smallest_size, options.largest_size};
  AdaptOptions with_geometry = options;
  const auto adapt_to = [&](const AnyMesh& from, const AnyField& asked) {
    return adapt(executor, from, metric_of(asked, from, bounds), with_geometry);
  };
  AdaptedMesh adapted = adapt_to(mesh, size_field(executor, mesh, sizes));
  const Sizes same = lasting(mesh, sizes);
  for (int times = 1; times < most_times; ++times) {
    const AnyField asked = size_field(executor, adapted.mesh, same);
    if (has_sizes(executor, adapted.metric, asked.values, options.smallest_size)) return adapted;
    if (times == 1) with_geometry.make = with_geometry_of(executor, mesh, options.make);
    AdaptedMesh again = adapt_to(adapted.mesh, asked);
    add_report_of(adapted.report, again.report);
    adapted = std::move(again);
  }
  return adapted;
}

}  // namespace ductile::meshadapt
