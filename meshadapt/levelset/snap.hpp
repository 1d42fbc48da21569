/// @file
/// snap(): puts vertices near the surface onto it, so that no edge is cut close to its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "levelset/crossings.hpp"

namespace ductile::meshadapt {

/// The surface as vertices and edges see it.
struct Snapped {
  std::vector<std::int8_t> sign_of;     ///< [vertex] -1, 1, or 0 on the surface
  std::vector<VertexOrigin> origin_of;  ///< [vertex]
  std::vector<Crossing> crossings;      ///< that are left, none close to an end
  std::size_t moved = 0, taken = 0;     ///< vertices, see CutReport
};

/// Moves vertices of the domain along crossing edges onto the surface, the nearest ones first.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
Snapped snap(const runtime::Executor& executor, CutDomain<Dim>& domain,
             const std::vector<double>& value_of, std::vector<Crossing> crossings);

extern template Snapped snap(const runtime::Executor&, CutDomain<2>&, const std::vector<double>&,
                             std::vector<Crossing>);
extern template Snapped snap(const runtime::Executor&, CutDomain<3>&, const std::vector<double>&,
                             std::vector<Crossing>);

}  // namespace ductile::meshadapt
