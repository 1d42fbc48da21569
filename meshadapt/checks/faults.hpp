/// @file
/// What check_mesh(), check_domain() and check_adapted() find, of meshes whose adjacency is made
/// once for all of them. Each function finds and throws what the public one of check_mesh.hpp does.
/// Thread safety of all: one caller; runs on the executor of the meshes, which is the same.
#pragma once

#include <string>
#include <vector>

#include "mesh/adjacency.hpp"

namespace ductile::meshadapt {

std::vector<std::string> mesh_faults(const AdjacentMesh& mesh);

std::vector<std::string> domain_faults(const AdjacentMesh& before, const AdjacentMesh& after,
                                       double hausdorff_tolerance);

std::vector<std::string> adapted_faults(const AdjacentMesh& before, const AdjacentMesh& after,
                                        double hausdorff_tolerance);

/// Throws InputError unless both are of one dimension, have all coordinates and references, and
/// name no vertices beyond those that there are.
void expect_comparable(const AnyMesh& before, const AnyMesh& after);

}  // namespace ductile::meshadapt
