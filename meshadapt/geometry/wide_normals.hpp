/// @file
/// wide_normals: which way facets are turned over the length of the surface tolerance. Thin facets
/// of level sets and of rounded coordinates turn by anything against those around them; that is
/// noise, no ridge, unless the surface itself turns there.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "geometry/classify.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

struct WideNormalOptions {
  double tolerance;   ///< steps that are lower may be noise
  double least_turn;  ///< cosine of the angle from which on a turn is much
};

/// [facet], of unit length and outwards from the facet's element; 0 if it is the facet's own. Empty
/// if all are. `beside` is [facet][side], the facet that has the side as well and may be of the
/// same patch, or none.
///
/// That of a facet that is lower than twice the tolerance and turns by much at a side is the mean,
/// by area, over what is beside it up to that distance, if the facet rises by less than the
/// tolerance from that, and if the surface is smooth there: if the normals do not cancel, as at the
/// rim of a thin plate, and if the means to either side of the facet, whichever way it is divided,
/// turn little against each other. Linear, but quadratic in how many facets are within that
/// distance of each other. Thread safety: one caller; runs on the executor. Throws std::bad_alloc.
template <int Dim>
std::vector<Vector<Dim>> wide_normals(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                                      const std::vector<TaggedFacet<Dim>>& facets,
                                      std::span<const std::array<std::uint32_t, Dim>> beside,
                                      const WideNormalOptions& options);

extern template std::vector<Vector<2>> wide_normals<2>(
    const runtime::Executor&, const Mesh<2>&, const std::vector<TaggedFacet<2>>&,
    std::span<const std::array<std::uint32_t, 2>>, const WideNormalOptions&);
extern template std::vector<Vector<3>> wide_normals<3>(
    const runtime::Executor&, const Mesh<3>&, const std::vector<TaggedFacet<3>>&,
    std::span<const std::array<std::uint32_t, 3>>, const WideNormalOptions&);

}  // namespace ductile::meshadapt
