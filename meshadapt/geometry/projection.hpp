/// @file
/// Projection: projects a point onto the user's surface functions.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "geometry/classify.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// The closest point, nearly; unknown_place() where the caller's function does not know it. Throws
/// InputError if the function returns a point that is too far away, and the function's exceptions.
/// Thread safety: any thread.
template <int Dim>
using Projection = std::function<Vector<Dim>(const Vector<Dim>&)>;

template <int Dim>
Vector<Dim> unknown_place() {
  Vector<Dim> place;
  place.x.fill(std::numeric_limits<double>::quiet_NaN());
  return place;
}
template <int Dim>
bool is_known(const Vector<Dim>& place) {
  return std::isfinite(place[0]);
}

/// The largest distance of a point from its projection, by SurfaceFunction::approximate.
struct Reach {
  double exact, approximate;
};

/// [patch], empty where only the model of the mesh is known; or empty as a whole.
template <int Dim>
std::vector<Projection<Dim>> projections_of_patches(const Mesh<Dim>& mesh,
                                                    std::span<const SurfaceFunction> functions,
                                                    const Reach& reach);

/// The same of curves, [curve]. Where two surfaces meet that are functions, or one and a plane,
/// points go to both.
std::vector<Projection<3>> projections_of_curves(const Mesh<3>& mesh,
                                                 const std::vector<Projection<3>>& of_patch,
                                                 std::span<const CurveEdge> edges);

/// Throws InputError unless there is one function of a reference at most, and none is empty.
void expect_functions(std::span<const SurfaceFunction> functions);

}  // namespace ductile::meshadapt
