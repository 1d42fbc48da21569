/// @file
/// The option --recovery: how second derivatives of a solution are found.
#pragma once

#include <string>

#include "arguments.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"

namespace ductile::cli {

/// Least squares unless the option says otherwise. Throws UsageError.
inline meshadapt::Recovery recovery_in(const Arguments& arguments) {
  const std::string recovery = arguments.text("--recovery").value_or("least-squares");
  if (recovery == "projection") return meshadapt::Recovery::double_projection;
  if (recovery == "least-squares") return meshadapt::Recovery::least_squares;
  throw UsageError("option --recovery: expected least-squares or projection, found '" + recovery +
                   "'");
}

}  // namespace ductile::cli
