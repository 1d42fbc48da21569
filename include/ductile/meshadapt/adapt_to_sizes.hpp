/// @file
/// adapt_to_sizes: adapts a mesh to sizes said by places. Sizes are evaluated at vertices, so a
/// coarse mesh shows little of them: what comes out is adapted again to sizes evaluated there,
/// until its vertices have seen them all.
#pragma once

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Adapts `mesh` to `sizes`, and the result again while at some vertex of it they ask for less than
/// two thirds of what it was adapted to there; at most five times in all. Curved boundaries are
/// measured from options.make.geometry, or from `mesh`, each time. The report is that of the last
/// time, with the seconds and warnings of all; progress is told of all. Throws as size_field() and
/// adapt() do. Thread safety: any thread; runs on the executor.
AdaptedMesh adapt_to_sizes(const runtime::Executor& executor, const AnyMesh& mesh,
                           const Sizes& sizes, const AdaptOptions& options = {});

}  // namespace ductile::meshadapt
