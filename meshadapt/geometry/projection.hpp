/// @file
/// Projection: where a point lies on what a patch or a curve is truly like, by the functions that
/// the caller has given for surfaces.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "geometry/classify.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// The closest point, nearly. Throws InputError for what no projection can be, and what the
/// caller's function throws. Thread safety: any thread.
template <int Dim>
using Projection = std::function<Vector<Dim>(const Vector<Dim>&)>;

/// [patch], empty where the model of the mesh is all that is known; or empty as a whole. `reach` is
/// how far a point may be from its projection.
template <int Dim>
std::vector<Projection<Dim>> projections_of_patches(const Mesh<Dim>& mesh,
                                                    std::span<const SurfaceFunction> functions,
                                                    double reach);

/// The same of curves, [curve]. Where two surfaces meet that are functions, or one and a plane,
/// points go to both.
std::vector<Projection<3>> projections_of_curves(const Mesh<3>& mesh,
                                                 const std::vector<Projection<3>>& of_patch,
                                                 std::span<const CurveEdge> edges);

/// Throws InputError unless there is one function of a reference at most, and none is empty.
void expect_functions(std::span<const SurfaceFunction> functions);

extern template std::vector<Projection<2>> projections_of_patches(const Mesh<2>&,
                                                                  std::span<const SurfaceFunction>,
                                                                  double);
extern template std::vector<Projection<3>> projections_of_patches(const Mesh<3>&,
                                                                  std::span<const SurfaceFunction>,
                                                                  double);

}  // namespace ductile::meshadapt
