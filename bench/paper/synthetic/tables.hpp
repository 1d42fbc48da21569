/// @file
/// The tables of the synthetic benchmark: the time of each kernel by number of threads; the
/// interpolation error by number of elements.
#pragma once

#include <string>
#include <vector>

#include "march.hpp"
#include "shared/experiment.hpp"
#include "solution.hpp"

namespace ductile::paper {

/// An adapted mesh and its error.
struct ErrorRow {
  double elements = 0;
  InterpolationError error;
};

/// Prints the seconds per step and the parallel efficiency relative to the fewest threads, by
/// kernel; writes both to NAME, for plots.
void say_kernels(Experiment& experiment, const std::string& name, const MarchReport& report);

/// Prints the errors and the rates between rows; writes them to NAME, for plots.
void say_errors(Experiment& experiment, const std::string& name, const std::vector<ErrorRow>& rows);

/// The exponent r of error = constant * elements^-r from the first row to the last, away from the
/// jump.
double convergence_rate(const std::vector<ErrorRow>& rows);

}  // namespace ductile::paper
