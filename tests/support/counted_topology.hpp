/// @file
/// counted_topology: what adaptation must not change, counted from the cells alone. Shares no code
/// with the library's check_topology().
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt::test {

/// A line for all elements and one for those of each reference: vertices - edges + facets -
/// elements, the number of their parts by facets and by vertices in common, that of the parts of
/// the facets around them, and that of vertices where those meet themselves without an edge.
template <int Dim>
std::vector<std::string> counted_topology(const AnyMesh& mesh);

}  // namespace ductile::meshadapt::test
