/// @file
/// mark_crack_sides: which patches lie against another so that both could get the same edge, and
/// grow together.
#pragma once

#include <vector>

#include "geometry/facet_sides.hpp"

namespace ductile::meshadapt {

/// Sets `crack_side` of patches that have a rim in common with another that encloses an area, in 2D
/// both ends; in 3D only where they meet in an acute angle. In 3D also of those with facets that
/// lie against facets of another in one plane, as on both sides of a closed crack, where they have
/// two vertices in common. `straight` is how far what counts as a straight line may be off it.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
void mark_crack_sides(const runtime::Executor& executor, Mesh<Dim>& mesh,
                      const std::vector<TaggedFacet<Dim>>& facets, const FacetSides<Dim>& sides,
                      double straight);

extern template void mark_crack_sides(const runtime::Executor&, Mesh<2>&,
                                      const std::vector<TaggedFacet<2>>&, const FacetSides<2>&,
                                      double);
extern template void mark_crack_sides(const runtime::Executor&, Mesh<3>&,
                                      const std::vector<TaggedFacet<3>>&, const FacetSides<3>&,
                                      double);

}  // namespace ductile::meshadapt
