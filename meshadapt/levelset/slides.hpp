/// @file
/// may_slide(): may a vertex move towards another one without changing a boundary, an interface
/// between materials, a listed facet or a listed edge?
#pragma once

#include "levelset/cut_domain.hpp"

namespace ductile::meshadapt {

/// True if each facet the vertex must stay on is flat in the direction of the other, and so is the
/// curve that it is on, if any. Thread safety: any thread.
template <int Dim>
bool may_slide(const CutDomain<Dim>& domain, VertexId vertex, VertexId towards);

extern template bool may_slide(const CutDomain<2>&, VertexId, VertexId);
extern template bool may_slide(const CutDomain<3>&, VertexId, VertexId);

}  // namespace ductile::meshadapt
