/// @file
/// preserved: compares an adapted mesh with the one it was made from.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt::test {

/// What adaptation must have kept and has not, a line each: the measure of every region, of every
/// interface between two of them, of listed facets and of listed edges by reference (to 1e-9, or
/// what rounding of the coordinates allows); corners and required entities to the bit.
std::vector<std::string> changes_of_what_is_kept(const AnyMesh& before, const AnyMesh& after);

/// The above, check_mesh's findings, and metrics that are not finite and positive.
std::vector<std::string> faults_of(const runtime::Executor& executor, const AnyMesh& before,
                                   const AdaptedMesh& after);

/// Marks all listed facets as required: what lock_boundary asks for.
void require_facets(AnyMesh& mesh);

/// Lines joined, for messages.
std::string joined(const std::vector<std::string>& lines);

}  // namespace ductile::meshadapt::test
