/// @file
/// Whether all values of a field are numbers, to be asked before one that is not spreads.
#pragma once

#include <cmath>
#include <string>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "mesh/first_bad.hpp"

namespace ductile::meshadapt {

/// Throws InputError, naming the first vertex, if a value is infinite or not a number.
inline void expect_finite(const runtime::Executor& executor, const AnyField& field) {
  const std::size_t bad = first_bad(executor, field.values.size(),
                                    [&](std::size_t i) { return !std::isfinite(field.values[i]); });
  if (bad != no_index)
    throw InputError(field.name + ": expected finite numbers, found " +
                     std::to_string(field.values[bad]) + " at " +
                     entity("vertex", bad / stride_of(field)) + "; correct the field there");
}

}  // namespace ductile::meshadapt
