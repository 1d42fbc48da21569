/// @file
/// The tables of the synthetic benchmark, and what they show: the time of each kernel and how it
/// shrinks with more threads; the interpolation error and how it shrinks with more elements.
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

/// Says the seconds per step and the parallel efficiency against the fewest threads, kernel by
/// kernel; writes both to NAME, for plots.
void say_kernels(Experiment& experiment, const std::string& name, const MarchReport& report);

/// Says the errors and the rates from row to row; writes them to NAME, for plots.
void say_errors(Experiment& experiment, const std::string& name, const std::vector<ErrorRow>& rows);

/// The exponent r of error = constant * elements^-r from the first row to the last, beside the
/// jump.
double convergence_rate(const std::vector<ErrorRow>& rows);

}  // namespace ductile::paper
