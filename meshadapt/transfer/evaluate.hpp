/// @file
/// evaluate: values of a field, linear in each element, at points of its mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "transfer/locator.hpp"

namespace ductile::meshadapt {

/// A field of any number of components on a mesh.
struct Components {
  const std::vector<double>& values;  // [vertex * stride + component]
  std::size_t stride;
};

/// Sets result[component] to the field's value at a place, clamped to the values at the corners.
template <int Dim, int Space>
void evaluate(const FixedMesh<Dim, Space>& mesh, const Components& field, const Place<Dim>& place,
              double* result) {
  std::array<const double*, Dim + 1> corner;
  for (std::size_t i = 0; i <= Dim; ++i)
    corner[i] = &field.values[mesh.corners_of[place.element][i] * field.stride];
  for (std::size_t k = 0; k < field.stride; ++k) {
    double low = corner[0][k], high = low, sum = 0;
    for (std::size_t i = 0; i <= Dim; ++i) {
      low = std::min(low, corner[i][k]);
      high = std::max(high, corner[i][k]);
      sum += place.weight[i] * corner[i][k];
    }
    result[k] = std::clamp(sum, low, high);
  }
}

struct Evaluated {
  std::vector<double> values;  // [point * stride + component]
  std::size_t outside = 0;     // points outside the mesh
};

/// Evaluates at so many points; find(i, near) gives the place of each.
template <int Dim, int Space>
Evaluated evaluate_each(const runtime::Executor& executor, const Locator<Dim, Space>& locator,
                        const Components& field, std::size_t point_count, auto&& find) {
  Evaluated result{std::vector<double>(point_count * field.stride)};
  std::vector<std::uint8_t> outside(point_count);
  walk_in_blocks(executor, point_count, [&](std::size_t i, ElementId near) {
    const Place<Dim> place = find(i, near);
    outside[i] = place.inside ? 0 : 1;
    evaluate(locator.mesh(), field, place, &result.values[i * field.stride]);
    return place.element;
  });
  result.outside = runtime::parallel_reduce(
      executor, outside.size(), std::size_t{0}, [&](std::size_t i) { return outside[i]; },
      std::plus<>());
  return result;
}

/// Evaluates at coordinates[point * Space + axis]; outside, at the closest point of the mesh.
template <int Dim, int Space>
Evaluated evaluate_at(const runtime::Executor& executor, const Locator<Dim, Space>& locator,
                      const Components& field, std::span<const double> coordinates) {
  return evaluate_each(executor, locator, field, coordinates.size() / Space,
                       [&](std::size_t i, ElementId near) {
                         Vector<Space> point;
                         std::copy_n(&coordinates[i * Space], Space, point.x.begin());
                         return locator.find(point, Dim < Space ? none : near);
                       });
}

}  // namespace ductile::meshadapt
