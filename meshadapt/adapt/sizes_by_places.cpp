#include "adapt/sizes_by_places.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "metric/entities_of.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// Are the sizes of a metric about those asked for, or finer, where these are not below `smallest`?
template <int Dim>
bool has_sizes(const Executor& executor, const AnyField& metric, const std::vector<double>& size_of,
               double smallest) {
  constexpr double near_enough = 1.5;  // times the size asked for
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

/// The same sizes near places instead of near vertices, and edges in 3D, that carry a reference.
Sizes lasting(const AnyMesh& mesh, const Sizes& sizes) {
  Sizes result{.elsewhere = sizes.elsewhere, .bounds = sizes.bounds};
  each_source(sizes, [&](const SizeSource& source) {
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
  });
  return result;
}

}  // namespace

SizesByPlaces::SizesByPlaces(const AnyMesh& input, const Sizes& sizes, const SizeBounds& bounds)
    : sizes_(lasting(input, sizes)), first_(sizes), bounds_(bounds) {}

const AnyField* SizesByPlaces::next(const AdaptState& state) {
  constexpr int most_times = 5;
  times_ = state.pass == 0 ? 1 : times_ + 1;
  if (times_ > most_times) return nullptr;
  const AnyMesh& mesh = state.mesh();
  const AnyField asked = size_field(state.executor, mesh, state.pass == 0 ? first_ : sizes_);
  if (state.pass > 0) {
    const auto has = mesh.dimension == 2 ? has_sizes<2> : has_sizes<3>;
    if (has(state.executor, state.adapted().metric, asked.values, bounds_.smallest)) return nullptr;
  }
  metric_ = metric_of(asked, mesh, bounds_);
  return &metric_;
}

AdaptedMesh adapt_to_sizes(const Executor& executor, const AnyMesh& mesh, const Sizes& sizes,
                           const AdaptOptions& options) {
  SizesByPlaces source(mesh, sizes, {options.smallest_size, options.largest_size});
  return adapt(executor, mesh, source, options);
}

}  // namespace ductile::meshadapt
