/// @file
/// adapt_mesh: adapt() after its arguments are checked.
#pragma once

#include "ductile/meshadapt/adapt.hpp"

namespace ductile::meshadapt {

AdaptedMesh adapt_mesh(const runtime::Executor& executor, const AnyMesh& mesh,
                       const AnyField& metric, const AdaptOptions& options);

}  // namespace ductile::meshadapt
