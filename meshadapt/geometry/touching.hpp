/// @file
/// touching_vertices: where the boundary of a mesh lies against itself, as the two sides of a
/// closed crack do, or bodies that touch along a curve.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// Marks the vertices of these boundary facets that are within a distance of a facet they do not
/// belong to, and the corners of that facet. Takes a logarithm more than linear in the facets.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<std::uint8_t> touching_vertices(const runtime::Executor& executor,
                                            const Mesh<Dim>& mesh,
                                            const std::vector<Facet<Dim>>& facets, double within);

extern template std::vector<std::uint8_t> touching_vertices<2>(const runtime::Executor&,
                                                               const Mesh<2>&,
                                                               const std::vector<Facet<2>>&,
                                                               double);
extern template std::vector<std::uint8_t> touching_vertices<3>(const runtime::Executor&,
                                                               const Mesh<3>&,
                                                               const std::vector<Facet<3>>&,
                                                               double);

}  // namespace ductile::meshadapt
