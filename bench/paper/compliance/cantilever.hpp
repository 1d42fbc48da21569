/// @file
/// The cantilever: its regular start mesh, and the clamped and the pulled parts of its boundary.
/// References of boundary facets identify these, because adaptation keeps them.
#pragma once

#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::paper {

inline constexpr int held_reference = meshadapt::Side::left;
inline constexpr int pulled_reference = 7;

/// A mesh of cubic (2D: square) cells, `cells` across the height; a multiple of 10.
template <int Dim>
meshadapt::AnyMesh cantilever_mesh(int cells);

/// The boundary facets with this reference.
template <int Dim>
std::vector<meshadapt::Facet<Dim>> facets_with(const meshadapt::AnyMesh& mesh, int reference);

extern template meshadapt::AnyMesh cantilever_mesh<2>(int);
extern template meshadapt::AnyMesh cantilever_mesh<3>(int);
extern template std::vector<meshadapt::Facet<2>> facets_with<2>(const meshadapt::AnyMesh&, int);
extern template std::vector<meshadapt::Facet<3>> facets_with<3>(const meshadapt::AnyMesh&, int);

}  // namespace ductile::paper
