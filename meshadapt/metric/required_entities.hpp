/// @file
/// metric_of_required: the metric that the required entities around a vertex have by themselves,
/// seen from the metric that is asked for there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "mesh/mesh.hpp"
#include "metric/metric_of_element.hpp"
#include "metric/metric_range.hpp"

namespace ductile::meshadapt {

/// The corners of an entity, in order of their numbers; none where it has fewer.
template <int Dim>
using EntityCorners = std::array<VertexId, Dim + 1>;

/// The required elements around a vertex, the required facets that no such element has, and the
/// edges along required curves that neither has; of required vertices with none of these, the edges
/// to others such. Each once, in an order that depends on nothing but the mesh.
template <int Dim, int Space = Dim>
class RequiredAround {
 public:
  explicit RequiredAround(const Mesh<Dim, Space>& mesh) : mesh_(mesh) {}

  std::span<const EntityCorners<Dim>> of(VertexId v) {
    found_.clear();
    for (const ElementId e : mesh_.elements_of.of(v))
      if (mesh_.required_element(e)) add(mesh_.corners_of[e]);
    for (const ElementId e : mesh_.elements_of.of(v))
      for (std::size_t i = 0; i <= Dim; ++i)
        if (mesh_.corners_of[e][i] != v && mesh_.patches[mesh_.patches_of[e][i]].required)
          add(facet_of<Dim>(mesh_.corners_of[e], static_cast<int>(i)));
    if constexpr (Dim == 3)
      for (const CurveLink& link : mesh_.links_of.of(v))
        if (mesh_.curves[link.curve].required) add(std::array{v, link.to});
    return found_;
  }

  /// Edges between required vertices that the metric at v would have longer.
  std::span<const EntityCorners<Dim>> short_edges(VertexId v, const Metric<Space>& metric) {
    found_.clear();
    if (!mesh_.kind_of[v].required) return found_;
    for (const ElementId e : mesh_.elements_of.of(v))
      for (const VertexId w : mesh_.corners_of[e]) {
        const Vector<Space> edge = mesh_.site_of[w].position - mesh_.site_of[v].position;
        if (w != v && mesh_.kind_of[w].required && squared_length(metric, edge) < 1)
          add(std::array{v, w});
      }
    return found_;
  }

 private:
  /// Unless it is one, or a part of one, that is there.
  template <std::size_t N>
  void add(const std::array<VertexId, N>& corners) {
    EntityCorners<Dim> entity;
    entity.fill(none);
    std::copy(corners.begin(), corners.end(), entity.begin());
    std::sort(entity.begin(), entity.end());
    const auto has_all = [&](const EntityCorners<Dim>& other) {
      return std::all_of(corners.begin(), corners.end(), [&](VertexId c) {
        return std::find(other.begin(), other.end(), c) != other.end();
      });
    };
    if (std::none_of(found_.begin(), found_.end(), has_all)) found_.push_back(entity);
  }

  const Mesh<Dim, Space>& mesh_;
  std::vector<EntityCorners<Dim>> found_;
};

/// The space in which a metric is the unit tensor; its symmetric root maps into it.
template <int Dim>
struct UnitSpace {
  explicit UnitSpace(const Metric<Dim>& metric) : axes(principal_axes(metric)) {
    for (double& value : axes.value) value = std::sqrt(value);
  }
  Vector<Dim> there(const Vector<Dim>& d) const {
    Vector<Dim> result;
    for (std::size_t i = 0; i < Dim; ++i)
      result += axes.value[i] * dot(axes.vector[i], d) * axes.vector[i];
    return result;
  }
  Vector<Dim> back(const Vector<Dim>& d) const {
    Vector<Dim> result;
    for (std::size_t i = 0; i < Dim; ++i)
      result += dot(axes.vector[i], d) / axes.value[i] * axes.vector[i];
    return result;
  }
  /// The tensor of the space before the map whose lengths are those of `tensor` after it.
  Metric<Dim> back(const Metric<Dim>& tensor) const {
    Metric<Dim> result;
    std::array<Vector<Dim>, Dim> image;  // [axis], of a unit vector of space
    for (int i = 0; i < Dim; ++i) {
      Vector<Dim> unit;
      unit[i] = 1;
      image[static_cast<std::size_t>(i)] = there(unit);
    }
    std::size_t at = 0;
    for (std::size_t j = 0; j < Dim; ++j) {
      const Vector<Dim> seen = product(tensor, image[j]);
      for (std::size_t i = 0; i <= j; ++i) result.m[at++] = dot(image[i], seen);
    }
    return result;
  }
  PrincipalAxes<Dim> axes;  // of the root
};

/// Thickness of the unit ball of the metric across some of its directions: the size along one, the
/// geometric mean over two.
template <int Dim>
double size_across(const UnitSpace<Dim>& space, std::span<const Vector<Dim>> directions) {
  if constexpr (Dim == 3)
    if (directions.size() == 2)
      return std::sqrt(norm(cross(space.back(directions[0]), space.back(directions[1]))));
  return norm(space.back(directions[0]));
}

/// Logarithm of the metric in which the edges of an entity have length 1, where the metric asked
/// for is the unit tensor. Over the edges of a regular simplex of k dimensions, the sum of e e' is
/// (k + 1)/2 times the identity.
template <int Dim, int Space>
Metric<Space> log_of_entity(const Mesh<Dim, Space>& mesh, const EntityCorners<Dim>& corners,
                            const UnitSpace<Space>& space) {
  const auto count =
      static_cast<std::size_t>(std::find(corners.begin(), corners.end(), none) - corners.begin());
  const std::size_t along = count - 1;
  Metric<Space> sum;
  double shortest = 1e300, longest = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector<Space> edge =
          mesh.site_of[corners[i]].position - mesh.site_of[corners[j]].position;
      shortest = std::min(shortest, norm(edge));
      longest = std::max(longest, norm(edge));
      const Vector<Space> seen = space.there(edge);
      for (std::size_t column = 0, at = 0; column < Space; ++column)
        for (std::size_t row = 0; row <= column; ++row, ++at)
          sum.m[at] += seen.x[row] * seen.x[column];
    }
  PrincipalAxes<Space> axes = principal_axes(sum);
  std::array<std::size_t, Space> order;  // along the entity, then across it
  for (std::size_t i = 0; i < Space; ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return axes.value[a] > axes.value[b] || (axes.value[a] == axes.value[b] && a < b);
  });
  const double least = 1e-15 * axes.value[order[0]];
  double mean = 0;
  std::array<Vector<Space>, Space> across;
  for (std::size_t i = 0; i < along; ++i) {
    double& value = axes.value[order[i]];
    value = std::log(static_cast<double>(count) / (2 * std::max(value, least)));
    mean += value / static_cast<double>(along);
  }
  for (std::size_t i = along; i < Space; ++i) across[i - along] = axes.vector[order[i]];
  if (along < Space) {
    const double asked = size_across<Space>(space, std::span(across).first(Space - along));
    const double size = std::clamp(asked * std::exp(-mean / 2), std::min(asked, shortest),
                                   std::max(asked, longest));
    for (std::size_t i = along; i < Space; ++i) axes.value[order[i]] = 2 * std::log(asked / size);
  }
  return compose(axes);
}

/// A logarithm of a metric with no more stretch than this factor between sizes: the shortest ones
/// are longer. To lead over from entities that are stretched more would take too many elements, and
/// slivers are.
template <int Dim>
Metric<Dim> with_stretch_up_to(double most, const Metric<Dim>& log_metric) {
  PrincipalAxes<Dim> axes = principal_axes(log_metric);
  const double least = *std::min_element(axes.value.begin(), axes.value.end());
  for (double& value : axes.value) value = std::min(value, least + 2 * std::log(most));
  return compose(axes);
}

/// The longest edge of a vertex, in a metric.
template <int Dim, int Space>
double longest_edge(const Mesh<Dim, Space>& mesh, VertexId v, const Metric<Space>& metric) {
  double square = 0;
  for (const ElementId e : mesh.elements_of.of(v))
    for (const VertexId w : mesh.corners_of[e])
      square = std::max(
          square, squared_length(metric, mesh.site_of[w].position - mesh.site_of[v].position));
  return std::sqrt(square);
}

/// The mean over required entities, or nothing if there are none. It makes no sizes shorter than
/// 1/50 of the longest edge of the vertex: along that, sizes are interpolated, and those much below
/// it would hold over far too much of it.
template <int Dim, int Space>
std::optional<Metric<Space>> metric_of_required(const Mesh<Dim, Space>& mesh,
                                                RequiredAround<Dim, Space>& around, VertexId v,
                                                const Metric<Space>& asked) {
  auto entities = around.of(v);
  if (entities.empty()) entities = around.short_edges(v, asked);
  if (entities.empty()) return std::nullopt;
  const UnitSpace<Space> space(asked);
  Metric<Space> mean;
  for (const auto& corners : entities)
    mean += 1.0 / static_cast<double>(entities.size()) * log_of_entity(mesh, corners, space);
  constexpr double most_stretch = 16, parts = 50;
  PrincipalAxes<Space> axes =
      principal_axes(with_stretch_up_to(most_stretch, without_little_stretch(mean)));
  const double finest = std::max(0.0, 2 * std::log(parts / longest_edge(mesh, v, asked)));
  for (double& value : axes.value) value = std::exp(std::min(value, finest));
  return brought_into_range(space.back(compose(axes)));
}

}  // namespace ductile::meshadapt
