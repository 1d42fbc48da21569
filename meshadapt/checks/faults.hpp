/// @file
/// The faults that check_mesh(), check_domain() and check_adapted() report, for meshes whose
/// adjacency is made once for all checks. Each function returns and throws what its public
/// counterpart in check_mesh.hpp does. Thread safety of all: one caller; runs on the executor of
/// the meshes, which is the same.
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

/// Throws InputError unless both meshes have the same dimension, all coordinates and references,
/// and only existing vertices.
void expect_comparable(const AnyMesh& before, const AnyMesh& after);

}  // namespace ductile::meshadapt
