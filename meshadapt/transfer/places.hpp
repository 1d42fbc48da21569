/// @file
/// Checks before a transfer: coordinates are small enough for squared distances, and integrals are
/// not to be kept on a surface alone.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

/// Throws InputError, naming the first invalid point; `what` is the name of one.
inline void expect_places(const runtime::Executor& executor, std::span<const double> coordinates,
                          int dimension, const char* what) {
  const std::size_t bad = first_bad(executor, coordinates.size(), [&](std::size_t i) {
    return !(std::abs(coordinates[i]) <= 1e150);
  });
  if (bad == no_index) return;
  const std::size_t point = bad / static_cast<std::size_t>(dimension);
  refuse("expected coordinates from -1e150 to 1e150, found others at " +
         Wording("coordinates[" + std::to_string(bad) + "], " + what + " " + std::to_string(point),
                 entity(what, point)));
}

[[noreturn]] inline void refuse_projection() {
  throw InputError(
      "expected fields on a surface to be carried by their values (--interpolate, "
      "Carrying::by_value), because two surfaces do not overlap exactly; found conservative "
      "transfer");
}

}  // namespace ductile::meshadapt
