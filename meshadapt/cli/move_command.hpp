/// @file
/// MoveJob: what `ductile move`, and `ductile adapt -lag`, are asked for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "carried_fields.hpp"
#include "ductile/meshadapt/move.hpp"

namespace ductile::cli {

struct MoveJob {
  std::filesystem::path input, output;
  std::string displacement;  // a file, or a field of the mesh's file
  std::optional<std::filesystem::path> metric_in, metric_out, json;
  std::optional<double> size;
  CarriedFields fields;
  meshadapt::MoveOptions move;  // without the metric and fields
  int verbosity = 1, threads = 0;
};

/// Runs `adapt` with -lag. Throws UsageError for options that do not go with it.
int run_lag(const Arguments& arguments);

}  // namespace ductile::cli
