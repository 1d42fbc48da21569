/// @file
/// What adapt_to_sizes() asks after each time: whether the adapted mesh has the sizes that places
/// ask for, and what these places are once the mesh is another. For meshes adapted in parts, too.
#pragma once

#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// At most so many times in all.
inline constexpr int most_times = 5;

/// Whether a mesh that was adapted to `metric` was so to about the sizes that are asked for at its
/// vertices, or finer; none below `smallest` is expected. Thread safety: one caller; runs on the
/// executor.
bool has_sizes(const runtime::Executor& executor, const AnyField& metric,
               const std::vector<double>& size_of, double smallest);

/// The same sizes near places instead of near vertices, and edges in 3D, that carry a reference:
/// adaptation may remove those. Facets and regions stay. Thread safety: any thread.
Sizes lasting(const AnyMesh& mesh, const Sizes& sizes);

}  // namespace ductile::meshadapt
