/// @file
/// Pinches: where the boundary of a mesh meets itself, more than two of its facets on one edge, or
/// in 2D on one vertex. Elements on both sides of a pinch have it in common, and no facet.
#pragma once

#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// Of those facets that are listed, the ones on the boundary that may be at pinches: all that are
/// there, and few others. Nearly linear in what is listed; elements are looked at only if there are
/// such facets.
template <int Dim>
std::vector<Facet<Dim>> listed_facets_at_pinches(const AnyMesh& mesh);

/// How long the pinches are, in 2D how many, each as often as there is a pair of facets too many;
/// of a mesh with this boundary, or with these facets at its pinches.
template <int Dim>
double pinched_length(const AnyMesh& mesh, const std::vector<Facet<Dim>>& boundary);

extern template std::vector<Facet<2>> listed_facets_at_pinches<2>(const AnyMesh&);
extern template std::vector<Facet<3>> listed_facets_at_pinches<3>(const AnyMesh&);
extern template double pinched_length<2>(const AnyMesh&, const std::vector<Facet<2>>&);
extern template double pinched_length<3>(const AnyMesh&, const std::vector<Facet<3>>&);

}  // namespace ductile::meshadapt
