/// @file
/// The signed distance that `ductile metric distance` writes.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::cli {

/// See meshadapt::signed_distance().
struct DistanceField {
  /// Regions are given by references or names of elements; a tolerance of 0 is chosen by that
  /// function. Throws InputError, also for names that the mesh does not have.
  DistanceField(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                const std::vector<std::string>& regions, double tolerance);

  meshadapt::AnyField field;
  std::string summary;  ///< a line for the user
};

}  // namespace ductile::cli
