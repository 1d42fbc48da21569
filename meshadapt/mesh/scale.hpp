/// @file
/// Points of a mesh, its extent, and the tolerance for points on its flat boundary.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// The positions of some vertices. Copies number by number, because copying whole points goes
/// through memory and takes twice as long.
template <int Dim, std::size_t N>
std::array<Vector<Dim>, N> points_in(const AnyMesh& mesh,
                                     const std::array<std::uint32_t, N>& vertices) {
  std::array<Vector<Dim>, N> at;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t k = 0; k < Dim; ++k)
      at[i].x[k] = mesh.coordinates[vertices[i] * std::size_t{Dim} + k];
  return at;
}

/// The extent of a mesh, and the possible error of its boundary: flatness is tested to this
/// fraction of the extent (see boundary_parts.cpp), and coordinates are rounded.
struct Scale {
  double extent = 0, slack = 0;
};

template <int Dim>
Scale scale_of(const AnyMesh& mesh) {
  Scale scale;
  if (mesh.coordinates.empty()) return scale;
  double farthest = 0;
  for (std::size_t i = 0; i < Dim; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t at = i; at < mesh.coordinates.size(); at += Dim) {
      low = std::min(low, mesh.coordinates[at]);
      high = std::max(high, mesh.coordinates[at]);
    }
    scale.extent = std::max(scale.extent, high - low);
    farthest = std::max({farthest, std::abs(low), std::abs(high)});
  }
  scale.slack = 2e-10 * scale.extent + 16 * std::numeric_limits<double>::epsilon() * farthest;
  return scale;
}

/// The diagonal of the box around the vertices.
inline double diagonal_of(const AnyMesh& mesh) {
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  std::array<double, 3> low{}, high{};
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i) {
    const std::size_t axis = i % dimension;
    low[axis] = i < dimension ? mesh.coordinates[i] : std::min(low[axis], mesh.coordinates[i]);
    high[axis] = i < dimension ? mesh.coordinates[i] : std::max(high[axis], mesh.coordinates[i]);
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

}  // namespace ductile::meshadapt
