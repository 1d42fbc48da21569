/// @file
/// preserved: compares an adapted mesh with the one it was made from.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt::test {

/// Violations of what adaptation must keep, one line each: the measures of every region, of every
/// interface between two regions, of listed facets and of listed edges by reference (to 1e-9, or
/// what rounding of the coordinates allows); corners and required entities exactly.
std::vector<std::string> changes_of_what_is_kept(const AnyMesh& before, const AnyMesh& after);

/// The same, with check_mesh's faults and metrics that are not finite and positive.
std::vector<std::string> faults_of(const runtime::Executor& executor, const AnyMesh& before,
                                   const AdaptedMesh& after);

/// Makes all listed facets required, as lock_boundary does.
void require_facets(AnyMesh& mesh);

/// Lines joined, for messages.
std::string joined(const std::vector<std::string>& lines);

}  // namespace ductile::meshadapt::test
