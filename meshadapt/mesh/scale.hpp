/// @file
/// Scale: the extent of a mesh, and the tolerance for points on its flat boundary.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

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

}  // namespace ductile::meshadapt
