/// @file
/// adapt_part: adapts what one rank has, with the interfaces as they are.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

struct AdaptPartOptions {
  meshadapt::AdaptOptions adapt = {};  ///< required_gradation holds at interfaces
  /// References of facets, and of elements, that stay as they are; ascending.
  std::vector<std::int32_t> required_facets = {}, required_elements = {};
};

struct AdaptedPart {
  Part part;              ///< numbers are those of before, or -1 of new vertices
  Interfaces interfaces;  ///< the shared vertices, in the new part; no facets
  meshadapt::AdaptReport report;
};

/// Lists the facets that are on the part's boundary, or between references, without a label. An
/// empty part stays as it is.
void list_boundary(const runtime::Executor& executor, Part& part);

/// Adapts a part that lists its boundary to the metric that it wants, with shared vertices and
/// facets required, vertices that have a label, and what the options require. What is wanted at the
/// new vertices is interpolated, by logarithms, from the part before: what is adapted to near
/// interfaces is another, which goes over into the sizes that these have. Throws as adapt() does.
template <int Dim>
AdaptedPart adapt_part(const runtime::Executor& executor, Part part, const Interfaces& interfaces,
                       const AdaptPartOptions& options);

/// What is wanted, made finer at curved boundaries, see bound_at_curved_boundaries().
template <int Dim>
AnyField bound_at_curves(const runtime::Executor& executor, const Part& part,
                         const Interfaces& interfaces, const AdaptPartOptions& options);

extern template AnyField bound_at_curves<2>(const runtime::Executor&, const Part&,
                                            const Interfaces&, const AdaptPartOptions&);
extern template AnyField bound_at_curves<3>(const runtime::Executor&, const Part&,
                                            const Interfaces&, const AdaptPartOptions&);
extern template AdaptedPart adapt_part<2>(const runtime::Executor&, Part, const Interfaces&,
                                          const AdaptPartOptions&);
extern template AdaptedPart adapt_part<3>(const runtime::Executor&, Part, const Interfaces&,
                                          const AdaptPartOptions&);

}  // namespace ductile::petsc
