/// @file
/// adapt_part: adapts the part of one rank and keeps its interfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "distributed/interfaces.hpp"
#include "distributed/part.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

struct AdaptPartOptions {
  meshadapt::AdaptOptions adapt = {};  ///< required_gradation applies at interfaces
  /// References of facets, and of elements, to be kept unchanged; ascending.
  std::vector<std::int32_t> required_facets = {}, required_elements = {};
  /// Gives metrics after the target metric if there is only one rank.
  meshadapt::MetricSource* source = nullptr;
};

struct AdaptedPart {
  Part part;              ///< numbers are the old ones, or -1 for new vertices
  Interfaces interfaces;  ///< the shared vertices, in the new part; no facets
  meshadapt::AdaptReport report;
};

/// Lists the facets on the part's boundary, or between references, that have no label. Keeps an
/// empty part as it is.
void list_boundary(const runtime::Executor& executor, Part& part);

/// Adapts a part that lists its boundary to its target metric. Shared vertices and facets, labelled
/// vertices, and entities required by the options are kept. The target at new vertices is
/// interpolated from the old part by logarithms; near interfaces the mesh is adapted to a modified
/// metric that blends into the sizes there. Throws as adapt() does.
AdaptedPart adapt_part(const runtime::Executor& executor, Part part, const Interfaces& interfaces,
                       const AdaptPartOptions& options);

/// The target metric refined at curved boundaries, see bound_at_curved_boundaries().
AnyField bound_at_curves(const runtime::Executor& executor, const Part& part,
                         const Interfaces& interfaces, const AdaptPartOptions& options);

}  // namespace ductile::distributed
