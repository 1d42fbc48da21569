/// @file
/// evaluate: the values of a field at points of its mesh.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "transfer/locator.hpp"

namespace ductile::meshadapt {

/// A field of any number of components on a mesh.
struct Components {
  const std::vector<double>& values;  // [vertex * stride + component]
  std::size_t stride;
};

/// Sets result[component] to what the field has at a place. That lies between the values at the
/// corners, rounding or not.
template <int Dim>
void evaluate(const FixedMesh<Dim>& mesh, const Components& field, const Place<Dim>& place,
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

}  // namespace ductile::meshadapt
