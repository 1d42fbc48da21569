/// @file
/// counted_topology: the topology that adaptation must keep, counted from the cells alone. Shares
/// no code with the library's check_topology().
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt::test {

/// One line for all elements and one for those of each reference: the Euler characteristic; the
/// number of parts connected by facets, and by vertices; the number of parts of the facets around
/// them; and the number of vertices where these facets touch each other without a common edge.
template <int Dim>
std::vector<std::string> counted_topology(const AnyMesh& mesh);

}  // namespace ductile::meshadapt::test
