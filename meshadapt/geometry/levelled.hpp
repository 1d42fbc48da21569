/// @file
/// levelled_places: where vertices of noise in facets and curves would be without it. Steps,
/// needles and what rounding made become the surface that they are on the mean, ridges stay.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "geometry/classify.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct LevelledInput {
  const std::vector<TaggedFacet<Dim>>& facets;           ///< which have their patches
  std::span<const Vector<Dim>> normals;                  ///< [facet], see wide_normals()
  std::span<const std::array<VertexId, 2>> curve_edges;  ///< 3D
  std::span<const std::uint8_t> held;                    ///< [vertex], whether it stays
  double tolerance;                                      ///< noise is less
  double least_turn;  ///< cosine of the angle from which on a turn is much
};

/// [vertex]. Empty if there is no noise. Vertices move by at most half of the tolerance, towards
/// where facets have the normals that they count as having (Sun, Rosin, Martin & Langbein, "Fast
/// and effective feature-preserving mesh denoising", IEEE TVCG 13, 2007), and along the surface
/// away from each other, by half as much. They stay in flat patches and on curves. Where a curve
/// turns by much, but not over twice the tolerance to both sides, that is noise, too; elsewhere it
/// has a corner, which stays. Linear. Thread safety: one caller; runs on the executor. Throws
/// std::bad_alloc.
template <int Dim>
std::vector<Vector<Dim>> levelled_places(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                                         const LevelledInput<Dim>& input);

extern template std::vector<Vector<2>> levelled_places(const runtime::Executor&, const Mesh<2>&,
                                                       const LevelledInput<2>&);
extern template std::vector<Vector<3>> levelled_places(const runtime::Executor&, const Mesh<3>&,
                                                       const LevelledInput<3>&);

}  // namespace ductile::meshadapt
